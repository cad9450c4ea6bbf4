"use strict";(()=>{var re,iu,Gi,Fn,Ui,ul,su,sl,au,Bi,Wi,Fd,vo=Symbol.for("pv"),cl={},fl=[],Cd=/^m(i|n|o|s|text|space)$/,ji=Array.isArray,qi=fl.
slice,Yn=Object.assign;function qn(e){e&&e.parentNode&&e.remove()}function uu(e,t,n){var r,o,l,a={},c=arguments.length;for(l in t)
l=="key"?r=t[l]:l=="ref"&&typeof e!="function"?o=t[l]:a[l]=t[l];return c>2&&(a.children=c>3?qi.call(arguments,2):n),go(e,
a,r,o,null)}function go(e,t,n,r,o){var l={type:e,props:t,key:n,ref:r,__k:null,__:null,__b:0,__e:null,__c:null,constructor:vo,__v:o||
++iu,__i:-1,__u:0};return!o&&re.vnode&&re.vnode(l),l}function oe(e){return e.children}function Fr(e,t){this.props=e,this.context=t,this.__g=0}function Cn(e,t){if(t==null)return e.
__&&Cn(e.__,e.__i+1);for(var n;t<e.__k.length;t++)if((n=e.__k[t])&&n.__e)return n.__e;return typeof e.type!="function"||
e.props.__P?null:Cn(e)}function Dd(e){var t,n=e.__v,r=n.__e,o=[],l=[],a=e.__P;a&&((t=Yn({constructor:vo},n)).__v=n.__v+1,
re.vnode&&re.vnode(t),Yi(a,t,n,e.__n,a.namespaceURI,32&n.__u?[r]:null,o,r||Cn(n),32&n.__u,l),t.__v=n.__v,t.__.__k[t.__i]=
t,hu(o,t,l),n.__=n.__e=null,t.__e!=r&&cu(t))}function cu(e){if((e=e.__)&&e.__c&&!e.props.__P)return e.__e=null,e.__k.some(
function(t){return t&&(e.__e=t.__e)}),cu(e)}function ou(e){(8&e.__g||(e.__g|=8,Fn.push(e),ul++))&&Ui==re.debounceRendering||
((Ui=re.debounceRendering)||queueMicrotask)(fu)}function fu(){try{for(var e,t=1;Fn.length;)Fn.length>t&&Fn.sort(su),e=Fn.
shift(),t=Fn.length,8&e.__g&&Dd(e)}finally{(ul=Fn.length)&&(Ui||queueMicrotask)(fu)}}function pu(e,t,n,r,o,l,a,c,d,m,g){
var _,x,v,k,N,E,F=r.__k||fl,w=t.length;for(d=$d(n,t,F,d,w),_=0;_<w;_++)(v=n.__k[_])!=null&&(x=~v.__i&&F[v.__i]||cl,v.__i=
_,E=Yi(e,v,x,o,l,a,c,d,m,g),k=v.__e,(x.ref!=v.ref||8&x.__u)&&(x.ref&&Ki(x.ref,null,v,x),v.ref&&g.push(v.ref,v.__c||k,v)),
N=N||k,4&v.__u?(d=du(v,d,e,!x.__v),x.__e&&(x.__e=null)):typeof v.type=="function"&&E!==void 0?d=E:k&&(d=k.nextSibling),v.
__u&=-21);return n.__e=N,d}function $d(e,t,n,r,o){var l,a,c,d,m,g,_,x,v,k=n.length,N=k,E=0,F=0,w=e.__k=Array(o);for(l=0;l<
o;l++)(a=t[l])!=null&&typeof a!="boolean"&&typeof a!="function"?(typeof a!="object"||a.constructor===String?a=w[l]=go(null,
a):ji(a)?a=w[l]=go(oe,{children:a}):a.constructor===vo&&a.__b?a=w[l]=go(a.type,a.props,a.key,a.ref,a.__v):w[l]=a,d=l+E,a.
__=e,a.__b=e.__b+1,c=null,~(m=a.__i=Ld(a,n,d,N))&&(N--,(c=n[m])&&(c.__u|=2)),c&&c.__v?(a.__u|=16,m==d-1?E--:m==d+1?E++:m!=
d&&(m>d?E--:E++,F=1)):(~m||(o>k?E--:o<k&&E++),typeof a.type!="function"&&(a.__u|=4))):w[l]=null;if(F){for(g=[],_=[],l=0;l<
o;l++)if((a=w[l])&&16&a.__u){for(E=0,x=g.length;E<x;)g[v=E+x>>1]<a.__i?E=v+1:x=v;g[E]=a.__i,_[l]=E+1}for(E=g.length;l--;)
_[l]&&(_[l]==E?E--:w[l].__u|=4)}if(N)for(l=0;l<k;l++)!(c=n[l])||2&c.__u||(c.__e==r&&(r=Cn(c)),Zi(c,c));return r}function du(e,t,n,r){
var o,l,a,c;if(typeof e.type=="function"){if(e.props.__P)return t;if(o=e.__k)for(l=0;l<o.length;l++)o[l]&&(o[l].__=e,t=du(
o[l],t,n,!1));return t}for(t&&!t.parentNode&&(t=Cn(e))&&!t.parentNode&&(t=null),a=e.__e,c=t;c&&c.nodeType==8;)c=c.nextSibling;
for(a!=c&&(!r&&n.moveBefore&&a.parentNode?n.moveBefore(a,t):n.insertBefore(a,t||null)),t=a;(t=t&&t.nextSibling)&&t.nodeType==
8&&!t.data.startsWith("$s"););return t}function Ld(e,t,n,r){var o,l=e.key,a=e.type,c=t[n],d=c&&!(2&c.__u);if(c===null&&l==null||d&&l==c.key&&a==c.type)return n;
if(r>(d?1:0)){for(o=n-1;o>=0;o--)if((c=t[o])&&!(2&c.__u)&&l==c.key&&a==c.type)return o;for(o=n+1;o<t.length;o++)if((c=t[o])&&
!(2&c.__u)&&l==c.key&&a==c.type)return o}return-1}function lu(e,t,n){n==null&&(n=""),t[0]=="-"?e.setProperty(t,n):e[t]=n}
function il(e,t,n,r,o){var l,a;if(t=="style")if(typeof n=="string")e.style.cssText=n;else{if(typeof r=="string"&&(e.style.
cssText=r=""),r)for(t in r)n&&t in n||lu(e.style,t);if(n)for(t in n)r&&n[t]==r[t]||lu(e.style,t,n[t])}else if(t[0]=="o"&&
t[1]=="n")typeof n!="function"&&(n=null),typeof r!="function"&&(r=null),(e.__e||(e.__e={}))[t]=n,n&&r||(a=Wi[t]||(Wi[t]=
Rd(t)),(e.__a||(e.__a={}))[t]=Bi,l=t!=(t=t.replace(au,"$1")),(t=t.slice(2))[0]<"a"&&(t=t.toLowerCase()),n?e.addEventListener(
t,a,l):e.removeEventListener(t,a,l));else{if(o=="http://www.w3.org/2000/svg")t=t.replace(/xlink(H|:h)/,"h").replace(/sName$/,
"s");else if(t!="width"&&t!="height"&&t!="href"&&t!="list"&&t!="form"&&t!="tabIndex"&&t!="download"&&t!="rowSpan"&&t!="c\
olSpan"&&t!="role"&&t!="popover"&&t in e)try{return void(e[t]=n??"")}catch{}if(typeof n=="function")return;n==null||n===
!1&&t[4]!="-"?e.removeAttribute(t):e.setAttribute(t,t=="popover"&&n==1?"":n)}}function Rd(e){return function(t){var n=this.
__e;if(n){if(n=n[e],t[sl]==null)t[sl]=Bi++;else if(t[sl]<this.__a[e])return;return n(re.event?re.event(t):t)}}}function Yi(e,t,n,r,o,l,a,c,d,m){
var g,_,x,v,k,N,E,F,w,P,S,K,L,Z,G,X,W,A,B=t.type;if(t.constructor!==vo)return null;128&n.__u&&(d=32&n.__u,g=n.__c.__z)&&
(t.__u|=d,_=l=[],g.nodeType==8?c=al(g,l):l.push(g),c=l[0]||c),(g=re.__b)&&g(t);e:if(typeof B=="function"){x=a.length;try{
if(F=t.props,w=(g=B.prototype)&&g.render,P=(g=B.contextType)&&r[g.__c],S=g?P?P.props.value:g.__:r,(v=n.__c)?(t.__c=v,2&v.
__g&&(v.__g|=1)):(w?t.__c=v=new B(F,S):(t.__c=v=new Fr(F,S),v.constructor=B,v.render=Vd),P&&P.sub(v),v.state||(v.state={}),
v.__n=r,v.__g|=8,v.__h=[],v.__k=[]),w&&(v.__s||(v.__s=v.state),B.getDerivedStateFromProps&&(v.__s==v.state&&(v.__s=Yn({},
v.__s)),Yn(v.__s,B.getDerivedStateFromProps(F,v.__s)))),k=v.props,N=v.state,v.__v=t,n.__c){if(F!==k&&w&&!B.getDerivedStateFromProps&&
v.componentWillReceiveProps&&v.componentWillReceiveProps(F,S),t.__v==n.__v&&!(8&v.__g)||!(4&v.__g)&&v.shouldComponentUpdate&&
v.shouldComponentUpdate(F,v.__s,S)===!1){t.__v!=n.__v&&(v.props=F,v.state=v.__s,v.__g&=-9),t.__e=n.__e,t.__k=n.__k,t.__k.
some(function(C){C&&(C.__=t)}),fl.push.apply(v.__h,v.__k),v.__k=[],v.__h.length&&a.push(v),c=Cn(n);break e}v.componentWillUpdate&&
v.componentWillUpdate(F,v.__s,S),w&&v.componentDidUpdate&&v.__h.push(function(){v.componentDidUpdate(k,N,E)})}else w&&!B.
getDerivedStateFromProps&&v.componentWillMount&&v.componentWillMount(),w&&v.componentDidMount&&v.__h.push(v.componentDidMount);
v.context=S,v.props=F,v.__P=e,v.__g&=-5,K=re.__r,L=w?25:0;do v.__g&=-9,K&&K(t),g=v.render(v.props,v.state=v.__s,v.context);while(8&
v.__g&&++L<25);w&&(fl.push.apply(v.__h,v.__k),v.__k=[]),v.state=v.__s,v.getChildContext&&(r=Yn({},r,v.getChildContext())),
w&&n.__c&&v.getSnapshotBeforeUpdate&&(E=v.getSnapshotBeforeUpdate(k,N)),Z=g&&g.type===oe&&g.key==null?g.props.children:g,
F.__P&&(g=c,o=(e=F.__P).namespaceURI,d=l=null,n.props&&n.props.__P!=e&&(n.__k.some(function(C){C&&Zi(C,C)}),n.__k=null),
c=n.__k?Cn(n,0):null),c=pu(e,ji(Z)?Z:[Z],t,n,r,o,l,a,c,d,m),F.__P&&(t.__e=null,c=g),t.__u&=-161,_&&_.some(qn),v.__h.length&&
a.push(v),1&v.__g&&(v.__g&=-4)}catch(C){if(a.length=x,t.__v=null,d||l)if(C&&C.then){if(t.__u|=128|d,l){for(~(W=l.indexOf(
c||void 0))||(W=l.length);(A=l[W-1])&&A.nodeType==8;)W--;for(;W<l.length;W++)if(A=l[W])if(l[W]=null,G){if(A==X)break}else{
if(A.nodeType!=8)break;A.data.startsWith("$s")&&(X=al(G=A))}}if(!G){for(;c&&c.nodeType==8&&c.nextSibling;)c=c.nextSibling;
G=c}(g=al(G=t.__c.__z||(t.__c.__z=G)))?(t.__e=G,c=g):t.__e=c,c=c&&c.nextSibling}else l&&l.some(qn);else t.__e=n.__e;t.__k||
(t.__k=n.__k||[]),C&&C.then||mu(t),re.__e(C,t,n)}}else c=t.__e=Id(n.__e,t,n,r,o,l,a,d,m,e);return(g=re.diffed)&&g(t),c}function al(e,t){
if(e&&e.nodeType==8&&e.data.startsWith("$s"))for(var n=1;e=e.nextSibling;){if(e.nodeType==8){if(e.data.startsWith("$s"))
n++;else if(e.data.startsWith("/$s")&&!--n)return e}t&&t.push(e)}}function mu(e){e&&(e.__c&&(e.__c.__g|=4),e.__k&&e.__k.
some(mu))}function hu(e,t,n){for(var r=0;r<n.length;)Ki(n[r++],n[r++],n[r++]);re.__c&&re.__c(t,e),e.some(function(o){try{
e=o.__h,o.__h=[],e.some(function(l){l.call(o)})}catch(l){re.__e(l,o.__v)}})}function Id(e,t,n,r,o,l,a,c,d,m){var g,_,x,v,
k,N,E,F,w=n.props||cl,P=t.props,S=t.type;if(S=="svg"?o="http://www.w3.org/2000/svg":S=="math"?o="http://www.w3.org/1998/\
Math/MathML":o||(o="http://www.w3.org/1999/xhtml"),l){for(g=0;g<l.length;g++)if((k=l[g])&&(S?k.localName==S:k.nodeType==
3)){e=k,l[g]=null;break}}if(!e){if(F=m.ownerDocument||document,!S)return F.createTextNode(P);e=F.createElementNS(o,S,P.is?
P:m),c&&(re.__m&&re.__m(t,l),c=!1),l=null}if(S){if(m=S=="template"&&e.content||e,l=S=="textarea"&&P.defaultValue!=null?null:
l&&qi.call(m.childNodes),!c&&l)for(w={},g=0;g<e.attributes.length;g++)w[(k=e.attributes[g]).name]=k.value;for(g in w)k=w[g],
g=="dangerouslySetInnerHTML"?x=k:g=="children"||g in P||g=="value"&&"defaultValue"in P||g=="checked"&&"defaultChecked"in
P||il(e,g,null,k,o);for(g in P)k=P[g],g=="children"?v=k:g=="dangerouslySetInnerHTML"?_=k:g=="value"?N=k:g=="checked"?E=k:
c&&typeof k!="function"||w[g]===k||il(e,g,k,w[g],o);_?(c||x&&(_.__html==x.__html||_.__html==e.innerHTML)||(e.innerHTML=_.
__html),t.__k=[]):(x&&(e.textContent=""),(S=="foreignObject"||o=="http://www.w3.org/1998/Math/MathML"&&Cd.test(S))&&(o="\
http://www.w3.org/1999/xhtml"),pu(m,ji(v)?v:[v],t,n,r,o,l,a,l?l[0]:n.__k&&Cn(n,0),c,d),l&&l.some(qn)),c&&S!="textarea"||
(g="value",S=="progress"&&N==null?e.removeAttribute(g):N==null||N===e[g]&&(S!="progress"||N)||il(e,g,N,w[g],o),g="checke\
d",E!=null&&E!=e[g]&&il(e,g,E,w[g],o))}else w===P||c&&e.data==P||(e.data=P);return e}function Ki(e,t,n,r){try{typeof e==
"function"?t?t.__x=e(t)||1:r&&(r=r.__c||r.__e)&&(t=r.__x)&&(r.__x=null,typeof t=="function"?t():e(null)):e.current=t}catch(o){
re.__e(o,n)}}function Zi(e,t,n){var r,o,l,a;if(re.unmount&&re.unmount(e),!(r=e.ref)||r.current&&r.current!=e.__e||Ki(r,null,
t,e),r=e.__c){if(r.componentWillUnmount)try{r.componentWillUnmount()}catch(c){re.__e(c,t)}r.__P=r.__n=null}if(r=e.__k)for(a=
0;a<r.length;a++)r[a]&&Zi(r[a],t,typeof e.type!="function"||n&&!e.props.__P);!n&&(r=e.__c)&&(r=r.__z)&&(o=al(r,l=[]))&&(r==
e.__e&&l.some(qn),qn(o),qn(r)),n||qn(e.__e),e.__e=e.__c=e.__=null}function Vd(e,t,n){return this.constructor(e,n)}function gu(e,t){
var n,r,o,l;re.__&&re.__(e,t),t.nodeType==9&&(t=t.documentElement),r=(n=e&&32&e.__u)?null:t.__k,t.__k=go(oe,{children:[e]}),
o=[],l=[],Yi(t,t.__k,r||cl,cl,t.namespaceURI,r?null:t.firstChild?qi.call(t.childNodes):null,o,r?r.__e:t.firstChild,n,l),
hu(o,t.__k,l),t.__k.props.children=null}re={__e:function(e,t,n,r){for(var o,l,a;t=t.__;)if((o=t.__c)&&!(1&o.__g)){o.__g|=4;try{if((a=(l=o.constructor)&&l.getDerivedStateFromError)&&
o.setState(l.getDerivedStateFromError(e)),o.componentDidCatch&&(o.componentDidCatch(e,r||{}),a=1),a&&8&o.__g)return void(o.
__g|=2)}catch(c){e=c}}throw ul=0,e}},iu=0,Gi=function(e){return e!=null&&e.constructor===vo},Fr.prototype.setState=function(e,t){
var n=this.__s;n&&n!=this.state||(n=this.__s=Yn({},this.state)),typeof e=="function"&&(e=e(Yn({},n),this.props)),e&&(Yn(
n,e),this.__v&&(t&&this.__k.push(t),ou(this)))},Fr.prototype.forceUpdate=function(e){this.__v&&(this.__g|=4,e&&this.__h.
push(e),ou(this))},Fr.prototype.render=oe,Fn=[],ul=0,su=function(e,t){return e.__v.__b-t.__v.__b},sl=Symbol(),au=/(PointerCapture)$|Capture$/i,
Bi=0,Wi={},Fd=0;var Cr,De,Ji,vu,Xi=Object.is,pl=0,Tu=[],Qi=[],Fe=re,_u=Fe.__b,bu=Fe.__r,xu=Fe.diffed,wu=Fe.__c,yu=Fe.unmount,Su=Fe.__;function dl(e,t){
Fe.__h&&Fe.__h(De,e,pl||t),pl=0;var n=De.__H||(De.__H={__:[],__h:[]});return e>=n.__.length&&n.__.push({}),n.__[e]}function Au(e){
return pl=1,zd(Eu,e)}function zd(e,t,n){var r=dl(Cr++,2);if(r.t=e,!r.__c&&(r.__=[n?n(t):Eu(void 0,t),function(l){var a=(r.
__N||r.__)[0],c=r.t(a,l);Xi(a,c)||(r.__N=[c,r.__[1]],r.__c.setState({}))}],r.__c=De,!De.__f)){De.__f=!0;var o=De.shouldComponentUpdate;
De.shouldComponentUpdate=function(l,a,c){var d=this.__H;if(!d)return!0;var m=!1,g=this.props!=l;if(d.__.some(function(x){
x.__N&&(m=!0,Xi(x.__[0],x.__N[0])||(g=!0))}),o){var _=o.call(this,l,a,c);return m?_||g:_}return!m||g}}return r.__}function tt(e,t){
var n=dl(Cr++,3);!Fe.__s&&ts(n.__H,t)&&(n.__P=!0,n.__=e,n.u=t,De.__H.__h.push(n))}function Dr(e,t){var n=dl(Cr++,4);!Fe.
__s&&ts(n.__H,t)&&(n.__P=!1,n.__=e,n.u=t,De.__h.push(n))}function an(e){return pl=5,ml(function(){return{current:e}},[])}function ml(e,t){var n=dl(Cr++,7);return ts(n.__H,t)&&(n.__=e(),n.__H=t),n.__}function Hd(){var e;do{for(;e=Qi.shift();)try{_o(e)}catch(n){Fe.__e(n,{__:(e=e.__P)&&e.__v})}for(;e=Tu.shift();){var t=e.
__H;if(e.__P&&t)try{t.__h.some(_o),t.__h.some(es),t.__h=[]}catch(n){t.__h=[],Fe.__e(n,e.__v)}}}while(Qi.length)}Fe.__b=function(e){
De=null,_u&&_u(e)},Fe.__=function(e,t){e&&t.__k&&t.__k.__m&&(e.__m=t.__k.__m),Su&&Su(e,t)},Fe.__r=function(e){bu&&bu(e),
Cr=0;var t=(De=e.__c).__H;t&&(Ji==De?De.__h=[]:(t.__h.some(_o),t.__h.some(es),Cr=0),t.__h=[],t.__.some(function(n){n.__N&&
(n.__=n.__N),n.u=n.__N=void 0})),Ji=De},Fe.diffed=function(e){xu&&xu(e);var t=e.__c;t&&t.__H&&(t.__H.__h.length&&Mu(Tu.push(
t)),t.__H.__.some(function(n){n.u&&(n.__H=n.u)})),Ji=De=null},Fe.__c=function(e,t){t.some(function(n){try{n.__h.some(_o),
n.__h=n.__h.filter(function(r){return!r.__||es(r)})}catch(r){n.__h=[function(){throw r}]}}),wu&&wu(e,t)},Fe.unmount=function(e){
yu&&yu(e);var t,n,r=e.__c;r&&r.__H&&(r.__H.__.some(function(o){try{if(o.__P&&o.__c){if(n===void 0){for(n=e.__;n&&(!n.__c||
!n.__c.__P);)n=n.__;n=n&&n.__c}o.__P=n,Mu(Qi.push(o))}else _o(o)}catch(l){t=l}}),r.__H=void 0,t&&Fe.__e(t,r.__v))};var ku=typeof requestAnimationFrame==
"function";function Ud(e){var t,n=function(){clearTimeout(r),ku&&cancelAnimationFrame(t),setTimeout(e)},r=setTimeout(n,35);
ku&&(t=requestAnimationFrame(n))}function Mu(e){e!=1&&vu==Fe.requestAnimationFrame||((vu=Fe.requestAnimationFrame)||Ud)(
Hd)}function _o(e){var t=De,n=e.__c;typeof n=="function"&&(e.__c=void 0,n()),De=t}function es(e){var t=De;e.__c=e.__(),De=
t}function ts(e,t){return!e||e.length!=t.length||t.some(function(n,r){return!Xi(n,e[r])})}function Eu(e,t){return typeof t==
"function"?t(e):t}var Wd=Symbol.for("preact-signals");function _l(){if(bn>1)bn--;else{var e,t=!1;for((function(){var o=gl;for(gl=void 0;o!==
void 0;){var l=o.S;if(l.v===o.v)for(var a=l.t;a!==void 0;a=a.x)a.i===o.i&&(a.i=l.i);o=o.o}})();xo!==void 0;){var n=xo;for(xo=
void 0,hl++;n!==void 0;){var r=n.u;if(n.u=void 0,n.f&=-3,!(8&n.f)&&Pu(n))try{n.c()}catch(o){t||(e=o,t=!0)}n=r}}if(hl=0,bn--,
t)throw e}}function un(e){if(bn>0)return e();ns=++Gd,bn++;try{return e()}finally{_l()}}var bo,Ae=void 0;function wo(e){var t=Ae,
n=bo;Ae=void 0,bo=void 0;try{return e()}finally{Ae=t,bo=n}}var xo=void 0,bn=0,hl=0,Gd=0,ns=0,gl=void 0,vl=0;function Nu(e){
if(Ae!==void 0){var t=e.n;if(t===void 0||t.t!==Ae)return t={i:0,S:e,p:Ae.s,n:void 0,t:Ae,e:void 0,x:void 0,r:t},Ae.s!==void 0&&
(Ae.s.n=t),Ae.s=t,e.n=t,32&Ae.f&&e.S(t),t;if(t.i===-1)return t.i=0,t.n!==void 0&&(t.n.p=t.p,t.p!==void 0&&(t.p.n=t.n),t.
p=Ae.s,t.n=void 0,Ae.s.n=t,Ae.s=t),t}}function Ve(e,t){this.v=e,this.i=0,this.n=void 0,this.t=void 0,this.l=0,this.W=t?.
watched,this.Z=t?.unwatched,this.name=t?.name}Ve.prototype.brand=Wd;Ve.prototype.h=function(){return!0};Ve.prototype.S=function(e){
var t=this,n=this.t;n!==e&&e.e===void 0&&(e.x=n,this.t=e,n!==void 0?n.e=e:wo(function(){var r;(r=t.W)==null||r.call(t)}))};
Ve.prototype.U=function(e){var t=this;if(this.t!==void 0){var n=e.e,r=e.x;n!==void 0&&(n.x=r,e.e=void 0),r!==void 0&&(r.
e=n,e.x=void 0),e===this.t&&(this.t=r,r===void 0&&wo(function(){var o;(o=t.Z)==null||o.call(t)}))}};Ve.prototype.subscribe=
function(e){var t=this;return ze(function(){var n=t.value;wo(function(){return e(n)})},{name:"sub"})};Ve.prototype.valueOf=
function(){return this.value};Ve.prototype.toString=function(){return this.value+""};Ve.prototype.toJSON=function(){return this.
value};Ve.prototype.peek=function(){var e=this;return wo(function(){return e.value})};Object.defineProperty(Ve.prototype,
"value",{get:function(){var e=Nu(this);return e!==void 0&&(e.i=this.i),this.v},set:function(e){if(e!==this.v){if(hl>100)
throw new Error("Cycle detected");(function(n){bn!==0&&hl===0&&n.l!==ns&&(n.l=ns,gl={S:n,v:n.v,i:n.i,o:gl})})(this),this.
v=e,this.i++,vl++,bn++;try{for(var t=this.t;t!==void 0;t=t.x)t.t.N()}finally{_l()}}}});function I(e,t){return new Ve(e,t)}
function Pu(e){for(var t=e.s;t!==void 0;t=t.n)if(t.S.i!==t.i||!t.S.h()||t.S.i!==t.i)return!0;return!1}function Ou(e){for(var t=e.
s;t!==void 0;t=t.n){var n=t.S.n;if(n!==void 0&&(t.r=n),t.S.n=t,t.i=-1,t.n===void 0){e.s=t;break}}}function Fu(e){for(var t=e.
s,n=void 0;t!==void 0;){var r=t.p;t.i===-1?(t.S.U(t),r!==void 0&&(r.n=t.n),t.n!==void 0&&(t.n.p=r)):n=t,t.S.n=t.r,t.r!==
void 0&&(t.r=void 0),t=r}e.s=n}function Kn(e,t){Ve.call(this,void 0,t),this.x=e,this.s=void 0,this.g=vl-1,this.f=4}Kn.prototype=
new Ve;Kn.prototype.h=function(){if(this.f&=-3,1&this.f)return!1;if((36&this.f)==32||(this.f&=-5,this.g===vl))return!0;if(this.
g=vl,this.f|=1,this.i>0&&!Pu(this))return this.f&=-2,!0;var e=Ae;try{Ou(this),Ae=this;var t=this.x();(16&this.f||this.v!==
t||this.i===0)&&(this.v=t,this.f&=-17,this.i++)}catch(n){this.v=n,this.f|=16,this.i++}return Ae=e,Fu(this),this.f&=-2,!0};
Kn.prototype.S=function(e){if(this.t===void 0){this.f|=36;for(var t=this.s;t!==void 0;t=t.n)t.S.S(t)}Ve.prototype.S.call(
this,e)};Kn.prototype.U=function(e){if(this.t!==void 0&&(Ve.prototype.U.call(this,e),this.t===void 0)){this.f&=-33;for(var t=this.
s;t!==void 0;t=t.n)t.S.U(t)}};Kn.prototype.N=function(){if(!(2&this.f)){this.f|=6;for(var e=this.t;e!==void 0;e=e.x)e.t.
N()}};Object.defineProperty(Kn.prototype,"value",{get:function(){if(1&this.f)throw new Error("Cycle detected");var e=Nu(
this);if(this.h(),e!==void 0&&(e.i=this.i),16&this.f)throw this.v;return this.v}});function St(e,t){return new Kn(e,t)}function Cu(e){
var t=e.j;if(e.j=void 0,typeof t=="function"){bn++;var n=Ae;Ae=void 0;try{t()}catch(r){throw e.f&=-2,e.f|=8,rs(e),r}finally{
Ae=n,_l()}}}function rs(e){for(var t=e.s;t!==void 0;t=t.n)t.S.U(t);e.x=void 0,e.s=void 0,Cu(e)}function Bd(e){if(Ae!==this)
throw new Error("Out-of-order effect");Fu(this),Ae=e,this.f&=-2;try{8&this.f&&rs(this)}finally{_l()}}function $r(e,t){this.
x=e,this.j=void 0,this.s=void 0,this.u=void 0,this.f=32,this.name=t?.name,bo&&bo.push(this)}$r.prototype.c=function(){var e=this.
S();try{if(8&this.f||this.x===void 0)return;var t=this.x();typeof t=="function"&&(this.j=t)}finally{e()}};$r.prototype.S=
function(){if(1&this.f)throw new Error("Cycle detected");this.f|=1,this.f&=-9,Cu(this),Ou(this),bn++;var e=Ae;return Ae=
this,Bd.bind(this,e)};$r.prototype.N=function(){2&this.f||(this.f|=2,this.u=xo,xo=this)};$r.prototype.d=function(){this.
f|=8,1&this.f||rs(this)};$r.prototype.dispose=function(){this.d()};function ze(e,t){var n=new $r(e,t);try{n.c()}catch(o){
throw n.d(),o}var r=n.d.bind(n);return r[Symbol.dispose]=r,r}var Du,xl,bl,jd=typeof window<"u"&&!!window.__PREACT_SIGNALS_DEVTOOLS__;var $u=[];ze(function(){Du=this.N})();function Lr(e,t){re[e]=t.bind(null,re[e]||function(){})}function yo(e){if(bl){var t=bl;
bl=void 0,t()}bl=e&&e.S()}function Lu(e){var t=this,n=e.data,r=Yd(n);r.name="ReactiveDom",r.value=n;var o=ml(function(){
for(var c=t,d=t.__v;d=d.__;)if(d.__c){d.__c.__$f|=4;break}var m=St(function(){var v=r.value.value;return v===0?0:v===!0?
"":v||""}),g=St(function(){return!Array.isArray(m.value)&&!Gi(m.value)}),_=ze(function(){if(this.N=Ru,g.value){var v=m.value;
c.__v&&c.__v.__e&&c.__v.__e.nodeType===3&&(c.__v.__e.data=v)}}),x=t.__$u.d;return t.__$u.d=function(){_(),x.call(this)},
[g,m]},[]),l=o[0],a=o[1];return l.value?a.peek():a.value}Lu.displayName="ReactiveTextNode";Object.defineProperties(Ve.prototype,
{constructor:{configurable:!0,value:uu(oe,null).constructor},type:{configurable:!0,value:Lu},props:{configurable:!0,get:function(){
var e=this;return{data:{get value(){return e.value}}}}},__b:{configurable:!0,value:1}});Lr("__b",function(e,t){if(yo(),xl=
void 0,typeof t.type=="string"){var n,r=t.props;for(var o in r)if(o!=="children"){var l=r[o];l instanceof Ve&&(n||(t.__np=
n={}),n[o]=l,r[o]=l.peek())}}e(t)});Lr("__r",function(e,t){if(e(t),t.type!==oe){yo();var n,r=t.__c;r&&(r.__$f&=-2,(n=r.__$u)===
void 0&&(r.__$u=n=(function(o,l){var a;return ze(function(){a=this},{name:l}),a.c=o,a})((function(o){return function(){var l;
jd&&((l=this.y)==null||l.call(this)),o.__$f|=1,o.setState({})}})(r),typeof t.type=="function"?t.type.displayName||t.type.
name:""))),xl=r,yo(n)}});Lr("__e",function(e,t,n,r){yo(),xl=void 0,e(t,n,r)});Lr("diffed",function(e,t){yo(),xl=void 0;var n;
if(typeof t.type=="string"&&(n=t.__e)){var r=t.__np,o=t.props,l=n.U;if(l)for(var a in l){var c=l[a];c===void 0||r&&a in r||
(c.d(),l[a]=void 0)}if(r){l||(l={},n.U=l);for(var d in r){var m=l[d],g=r[d];m===void 0?(m=qd(n,d,g,o),l[d]=m):m.o(g,o)}}}
e(t)});function qd(e,t,n,r){var o=t in e&&e.ownerSVGElement===void 0,l=I(n);return{o:function(a,c){l.value=a,r=c},d:ze(function(){
this.N=Ru;var a=l.value.value;r[t]!==a&&(r[t]=a,o?e[t]=a:a!=null&&(a!==!1||t[4]==="-")?e.setAttribute(t,a):e.removeAttribute(
t))})}}Lr("unmount",function(e,t){if(typeof t.type=="string"){var n=t.__e;if(n){var r=n.U;if(r){n.U=void 0;for(var o in r){
var l=r[o];l&&l.d()}}}var a=t.__np;if(a){var c=t.props;for(var d in a)c[d]=a[d]}t.__np=void 0}else{var m=t.__c;if(m){m.__$f|=
8;var g=m.__$u;g&&(m.__$u=void 0,g.d())}}e(t)});Lr("__h",function(e,t,n,r){r<3&&(t.__$f|=2),e(t,n,r)});Fr.prototype.shouldComponentUpdate=
function(e,t){if(this.__R)return!0;var n=this.__$u,r=n&&n.s!==void 0;for(var o in t)return!0;if(this.__f||typeof this.u==
"boolean"&&this.u===!0){var l=2&this.__$f;if(!(r||l||4&this.__$f)||1&this.__$f)return!0}else if(!(r||4&this.__$f)||3&this.
__$f)return!0;for(var a in e)if(a!=="__source"&&e[a]!==this.props[a])return!0;for(var c in this.props)if(!(c in e))return!0;
return!1};function Yd(e,t){return ml(function(){return I(e,t)},[])}var Kd=function(e){queueMicrotask(function(){queueMicrotask(e)})};function Zd(){un(function(){for(var e;e=$u.shift();)Du.call(e)})}function Ru(){$u.push(this)===1&&(re.requestAnimationFrame||
Kd)(Zd)}var Jd=95,os=new Set,ls=!1,Iu=0;function Vu(e){if(e-Iu<Jd){requestAnimationFrame(Vu);return}ls=!1,Iu=e;let t=[...os];os.
clear(),un(()=>t.forEach(n=>{n.value+=1}))}function kt(e){os.add(e),!ls&&(ls=!0,requestAnimationFrame(Vu))}var zu={int8:1,uint8:1,int16:2,uint16:2,int32:4,uint32:4,int64:8,uint64:8,float32:4,float64:8,string:4},Hu=e=>zu[e],Xd=/^# MAVLink (\S+) \((\d+)\)/,
Qd=/^(\w+) (\w+)=(-?\d+)$/,em=/^(\w+?)(?:\[(\d+)\])? (\w+)(?:\s*#(?: \[(.*?)\])?(?: invalid: (\S+))?)?$/;function tm(e){
let t=e.filter(n=>n!==0);return t.length>1&&Math.max(...t)>2&&t.every(n=>Number.isInteger(Math.log2(n)))}function nm(e,t,n){
let r=`${t.toUpperCase()}_`,o=e.slice(r.length);return e.startsWith(r)&&n.has(o)?o:e}function rm(e,t,n){if(t.length===0)
return null;let r=new Map(t.map(([o,l])=>[l,nm(o,e,n)]));for(let[o]of t)n.add(o);return r}function om(e,t,n){let[,r="",o,
l="",a="",c=""]=e;if(!(r in zu))throw new Error(`the schema has a type that MAVLink does not have: ${r}`);let d=rm(l,t,n);
return{name:l,type:r,length:o===void 0?null:Number(o),unit:a,invalid:c,entries:d,isFlags:d!==null&&tm([...d.keys()])}}function Uu(e){
let t=e.split(`
`).map(a=>a.trim()).filter(a=>a!==""),n=t[0]?.match(Xd),r=[],o=new Set,l=[];for(let a of t){let c=a.match(Qd);c&&l.push(
[c[2]??"",Number(c[3])]);let d=c||a.startsWith("#")?null:a.match(em);d&&(r.push(om(d,l,o)),l=[])}return{name:n?.[1]??"",
id:n?Number(n[2]):null,fields:r,indexOf:new Map(r.map((a,c)=>[a.name,c]))}}var lm="mavlink/msg/",Wu=500,im=1e4,sm=1e4,am=8e3,mt=I(!1),Ir=I(null),ko=I(null),To=I(""),jt=I(0),st=new Map,is=new Map,
Mo=new Map,Rr=new Map,Gu=new Set,Zn=null,So=Wu,wl=0,yl=0;function um(e){if(!e.schemaName.startsWith(lm))return null;let t=is.
get(e.schemaName);if(t)return t;let n=Uu(e.schema);return is.set(e.schemaName,n),n}function Bu(e){Zn?.readyState===WebSocket.
OPEN&&Zn.send(JSON.stringify(e))}function ju(e){let t=e.flatMap(n=>st.get(n)?.id??[]);t.length>0&&Bu({op:"subscribe",subscriptions:t.
map(n=>({id:n,channelId:n}))})}function cm(e){let t=st.get(e);t&&Bu({op:"unsubscribe",subscriptionIds:[t.id]})}function fm(e){
for(let t of e)st.set(t.topic,{id:t.id,topic:t.topic,encoding:t.encoding,schema:um(t)}),Mo.set(t.id,t.topic);ju(e.map(t=>t.
topic).filter(t=>Rr.has(t))),kt(jt)}function pm(e){for(let t of e){let n=Mo.get(t);n!==void 0&&st.get(n)?.id===t&&st.delete(
n),Mo.delete(t)}kt(jt)}function dm(e){let t=JSON.parse(e);t.op==="advertise"?fm(t.channels??[]):t.op==="unadvertise"?pm(
t.channelIds??[]):t.op==="serverInfo"?To.value=t.name??"":t.op==="status"&&console.warn(t.message)}function mm(e){let t=new DataView(
e);if(t.byteLength<13||t.getUint8(0)!==1)return;let n=Rr.get(Mo.get(t.getUint32(1,!0))??""),r=Number(t.getBigUint64(5,!0)/
1000n),o=new DataView(e,13);n?.forEach(l=>l(o,r))}function hm(){yl=performance.now(),So=Wu,un(()=>{mt.value=!0,Ir.value=
ko.value=null});for(let e of Gu)e()}function qu(){clearTimeout(wl),Zn=null,st.clear(),Mo.clear(),is.clear(),un(()=>{(mt.
value||ko.value===null)&&(ko.value=Date.now()),mt.value=!1,Ir.value=Date.now()+So}),wl=window.setTimeout(Ao,So),So=Math.
min(im,So*1.6)}function Yu(){document.addEventListener("visibilitychange",()=>{yl=performance.now()}),setInterval(()=>{if(!mt.
value||document.hidden||performance.now()-yl<sm)return;let e=Zn;qu(),e?.close()},1e3)}function Ao(){if(clearTimeout(wl),
Zn)return;Ir.value=null;let e=new WebSocket(`${location.protocol==="https:"?"wss":"ws"}://${location.host}/`,["foxglove.\
sdk.v1","foxglove.websocket.v1"]);e.binaryType="arraybuffer",e.onopen=hm,e.onclose=()=>{Zn===e&&qu()},e.onmessage=({data:t})=>{
yl=performance.now(),typeof t=="string"?dm(t):mm(t)},Zn=e,wl=window.setTimeout(()=>{e.readyState===WebSocket.CONNECTING&&
e.close()},am)}function Vr(e,t){let n=Rr.get(e)??new Set;return n.add(t),Rr.set(e,n),n.size===1&&ju([e]),()=>{n.delete(t),
!(n.size>0||Rr.get(e)!==n)&&(Rr.delete(e),cm(e))}}function Ku(e){Gu.add(e),mt.value&&e()}var Sl=I(!document.hidden);document.addEventListener("visibilitychange",()=>{Sl.value=!document.hidden});var gm=new TextDecoder,
Jn=class{constructor(t,n){this.take=n;Ku(()=>{this.loads.value+=1}),ze(()=>{if(!(this.wanted.value===0||!Sl.value||this.
loads.value===0))return this.isNew=!0,Vr(`/mavloom/${t}`,r=>this.apply(gm.decode(r)))})}take;version=I(0);wanted=I(0);loads=I(
0);isNew=!0;use(){return this.wanted.value+=1,()=>{this.wanted.value-=1}}apply(t){this.take(JSON.parse(t),this.isNew),this.
isNew=!1,kt(this.version)}},ss=0,Zu=0;function Eo(e){ss=e,Zu=performance.now()}function Xn(){return ss===0?Date.now()/1e3:
ss/1e6+(mt.peek()?(performance.now()-Zu)/1e3:0)}var ht=I(0);setInterval(()=>{document.hidden||(ht.value+=1)},1e3);var kl=I([]),Ml=I([]),zr=I([]),as=I(0),gt=new Map,Tl=new Jn("vehicles",e=>{Eo(e.time_us),kl.value=e.vehicles}),Qn=new Jn(
"alarms",e=>{Eo(e.time_us),zr.value=e.alarms,as.value=e.left_out}),Hr=e=>`${e.sys}/${e.comp}`;function us(e){return zr.value.
filter(t=>t.ended_us===null&&t.sys===e.sys&&(t.comp===null||t.comp===e.comp))}var cs=e=>e.autopilot!==null&&e.autopilot!==
"MAV_AUTOPILOT_INVALID"&&e.type!=="MAV_TYPE_GCS",Ju=120,No=new Map,Al=e=>[e,...e.links].reduce((t,n)=>t+n.losses.reduce(
(r,o)=>r+o.count,0),0);function vm(e){let t=No.get(e.name)??{rates:[],lost:[]};No.set(e.name,t),t.rates.push(Math.max(e.
hz_in??0,e.hz_out??0)),t.lost.push({at:performance.now()/1e3,total:Al(e)}),t.rates.length>Ju&&t.rates.shift(),t.lost.length>
Ju&&t.lost.shift()}function fs(e){let t=performance.now()/1e3-10,n=No.get(e.name)?.lost.find(r=>r.at>=t);return n?Math.max(
0,Al(e)-n.total):0}var xn=new Jn("links",e=>{Eo(e.time_us),Ml.value=e.hops,e.hops.forEach(vm)}),Xu=()=>Ml.value.flatMap(
e=>e.hint??[]),Qu=0,_m=4e5,bm=2e4,xm=60;function wm(e,t){let n=`${e.link??""} ${e.topic}`,r=gt.get(n)?.newAt??(t<Qu+_m?0:
t/1e6);gt.set(n,{...e,key:n,seenAt:t/1e6-(e.age_s??0),newAt:r})}function ym(){if(!(gt.size<=bm))for(let e of gt.values())
Ur(e)>xm&&gt.delete(e.key)}var El=new Jn("traffic",(e,t)=>{Eo(e.time_us),t&&(gt.clear(),Qu=e.time_us);for(let n of e.rows)
wm(n,e.time_us);ym()}),Ur=e=>Math.max(0,Xn()-e.seenAt),ps=(e,t=Ur(e))=>e.silent_after_s!=null&&t>e.silent_after_s;function Nl(e,t=Ur(
e)){return t>1.5&&t*e.hz>3?1/t:e.hz}var Sm=["overview","messages","plots"],er=["link","source","name","id","hz","count","bytes","share","gaps","jitter","age"],
km=["source","name","hz","count","share","jitter","age"],ds=[10,30,60,300,900],Fl=8,ms=8;function tc(){return{view:"over\
view",query:"",sort:{column:"source",isDown:!1},columns:[...km],opened:null,plots:[],span:60}}var Pl=e=>encodeURIComponent(
e).replace(/[~!']/g,t=>`%${t.charCodeAt(0).toString(16).toUpperCase()}`).replaceAll("%2F","/").replaceAll("%2C",",");function Ol(e){
try{return decodeURIComponent(e)}catch{return""}}function Mm(e){let t=[Pl(e.topic),Pl(e.formula),String(e.axis),String(e.
scale),String(e.offset)],n=["","","0","1","0"];for(;t.length>2&&t.at(-1)===n[t.length-1];)t.pop();return t.join("~")}var ec=(e,t)=>e!==
void 0&&e!==""&&Number.isFinite(Number(e))?Number(e):t;function Tm(e){let[t="",n="",r,o,l]=e.split("~");return t===""||n===
""?[]:[{topic:Ol(t),formula:Ol(n),axis:r==="1"?1:0,scale:ec(o,1),offset:ec(l,0)}]}function Cl(e){let t=tc(),n=[],r=(o,l,a)=>{
l!==a&&n.push(`${o}=${l}`)};r("q",Pl(e.query),""),r("sort",`${e.sort.isDown?"-":""}${e.sort.column}`,t.sort.column),r("c\
ols",e.columns.join(","),t.columns.join(",")),r("open",Pl(e.opened??""),""),r("span",String(e.span),String(t.span));for(let o of e.
plots)n.push(`plot=${o.map(Mm).join("!")}`);return e.view+(n.length>0?`?${n.join("&")}`:"")}function Am(e,t){t.length>0&&
e.plots.push(t)}function Em(e,t,n){if(t==="q"&&(e.query=Ol(n)),t==="open"&&(e.opened=Ol(n)||null),t==="span"&&ds.includes(
Number(n))&&(e.span=Number(n)),t==="cols"&&(e.columns=er.filter(o=>o==="name"||n.split(",").includes(o))),t==="plot"&&e.
plots.length<Fl&&Am(e,n.split("!").flatMap(Tm).slice(0,ms)),t!=="sort")return;let r=n.replace(/^-/,"");er.includes(r)&&(e.
sort={column:r,isDown:n.startsWith("-")})}function hs(e){let t=tc(),[n="",r=""]=e.replace(/^#/,"").split("?",2);Sm.includes(
n)&&(t.view=n);for(let o of r.split("&")){let l=o.indexOf("=");l>0&&Em(t,o.slice(0,l),o.slice(l+1))}return t}var tr=hs(location.hash),He=I(tr.view),cn=I(tr.query),qt=I(tr.sort),fn=I(tr.columns),ge=I(tr.opened),pe=I(tr.plots),pn=I(
tr.span),Mt=I(!1),Po=I(""),nc=0;function Dl(e){Po.value=e,clearTimeout(nc),nc=window.setTimeout(()=>{Po.value=""},4e3)}function Nm(){
return{view:He.value,query:cn.value,sort:qt.value,columns:fn.value,opened:ge.value,plots:pe.value,span:pn.value}}function Pm(e){
un(()=>{He.value=e.view,cn.value=e.query,qt.value=e.sort,fn.value=e.columns,ge.value=e.opened,pe.value=e.plots,pn.value=
e.span})}function rc(){let e=`${He.value} ${ge.value}`;ze(()=>{let n=`#${Cl(Nm())}`,r=`${He.value} ${ge.value}`;n!==location.
hash&&history[r===e?"replaceState":"pushState"](null,"",n),e=r});let t=()=>{let n=hs(location.hash);e=`${n.view} ${n.opened}`,
Pm(n)};addEventListener("popstate",t)}function Wr(e,t){return{topic:e,formula:t,axis:0,scale:1,offset:0}}function Oo(e,t=pe.
value.length>0?pe.value.length-1:null){let n=t===null?void 0:pe.value[t];if(n?.some(o=>o.topic===e.topic&&o.formula===e.
formula))return Dl(`${e.formula} is in plot ${(t??0)+1} already`);if(n&&n.length<ms)return pe.value=pe.value.map((o,l)=>l===
t?[...o,e]:o),Dl(`${e.formula} added to plot ${(t??0)+1}`);if(pe.value.length===Fl)return Dl(`there are ${Fl} plots alre\
ady: remove one first`);pe.value=[...pe.value,[e]],Dl(`${e.formula} added to plot ${pe.value.length}`)}var Om=new Intl.NumberFormat("en-US"),at=e=>e==null?"\u2013":Om.format(e);function $e(e,t){return e==null||!Number.isFinite(
e)?"\u2013":e.toFixed(t).replace(/^-(?=[0.]*$)/,"")}function Tt(e){return e==null?"\u2013":e>0&&e<.05?"<0.1":e.toFixed(1)}
function Fo(e){if(e==null)return"\u2013";let t=["B","kB","MB","GB","TB"],n=0;for(;e>=1e3&&n<t.length-1;)e/=1e3,++n;return`${n===
0?e:e.toFixed(e<100?1:0)} ${t[n]}`}function Yt(e){return e==null||!Number.isFinite(e)?"\u2013":e<1?"<1 s":e<120?`${Math.
floor(e)} s`:e<7200?`${Math.floor(e/60)} min`:e<172800?`${Math.floor(e/3600)} h`:`${Math.floor(e/86400)} d`}var Fm=e=>String(
e).padStart(2,"0");function $l(e){let t=new Date(e/1e3);return[t.getHours(),t.getMinutes(),t.getSeconds()].map(Fm).join(
":")}function Co(e,t){if(typeof e=="string")return e;if(!t||typeof e=="bigint")return e.toString();if(!Number.isFinite(e))
return Number.isNaN(e)?"NaN":e>0?"\u221E":"\u2212\u221E";let n=Math.abs(e);return e!==0&&(n>=1e7||n<1e-6)?e.toExponential(
4):e.toFixed(n>=1e3?2:n>=100?3:n>=10?4:5)}function Gr(e){let t=Math.abs(e);return Number.isFinite(e)?e!==0&&(t>=1e7||t<1e-4)?
e.toExponential(2):e.toFixed(t>=1e3?1:t>=100?2:t>=1?3:4):"\u2013"}var Cm={px4:"PX4",ardupilotmega:"ArduPilot",gcs:"Groun\
d station",adsb:"ADS-B",vtol:"VTOL",generic:"Generic autopilot"};function Do(e,t){if(e==null)return"\u2013";let n=e.replace(
new RegExp(`^${t}`),"").replaceAll("_"," ").toLowerCase();return Cm[n]??n.charAt(0).toUpperCase()+n.slice(1)}var Dm=Symbol.for("pv"),$m=0;function s(e,t,n,r,o,l){t||(t={});var a,c,d=t;if("ref"in d&&typeof e!="function")for(c in d={},t)c=="ref"?a=t[c]:d[c]=t[c];
var m={type:e,props:d,key:n,ref:a,__k:null,__:null,__b:0,__e:null,__c:null,constructor:Dm,__v:--$m,__i:-1,__u:0};return(o||
l)&&(m.__source=o,m.__self=l),re.vnode&&re.vnode(m),m}var Lm={error:"M8 1.5 15 14H1Z",warning:"M8 1 15 8 8 15 1 8Z",info:"M8 1.5a6.5 6.5 0 1 0 .01 0Z",live:"M8 3.5a4.5 4.5 0 \
1 0 .01 0Z",lost:"M3 3 13 13M13 3 3 13",connecting:"M8 2a6 6 0 1 1-6 6",down:"M3 3 13 13M13 3 3 13",up:"M8 3.5a4.5 4.5 0\
 1 0 .01 0Z",ended:"M3 8.5 6.5 12 13 4.5",auto:"M8 2a6 6 0 1 0 .01 0M8 2v12a6 6 0 0 0 0-12",light:"M8 5a3 3 0 1 0 .01 0M\
8 1v1.5M8 13.5V15M1 8h1.5M13.5 8H15M3 3l1 1M12 12l1 1M13 3l-1 1M4 12l-1 1",dark:"M13.5 9.5A6 6 0 1 1 6.5 2.5 5 5 0 0 0 1\
3.5 9.5Z",help:"M5.5 5.5a2.5 2.5 0 1 1 3.5 2.3c-.7.4-1 .8-1 1.7M8 12.5v.3",close:"M4 4 12 12M12 4 4 12",plot:"M2 2v12h12\
M4.5 10.5 7.5 6.5 10 9 13.5 4",pause:"M5.5 3v10M10.5 3v10",play:"M5 3 13 8 5 13Z",arrow:"M1 8h13M10 4l4 4-4 4"},Rm=["err\
or","warning","info","live","up","play"];function ue({name:e}){return s("svg",{class:`icon ${Rm.includes(e)?"filled":""}`,
viewBox:"0 0 16 16","aria-hidden":"true",children:s("path",{d:Lm[e]})})}var Ll=["auto","light","dark"],oc="mavloom-colours";function Im(){let e=localStorage.getItem(oc);return Ll.includes(e)?e:
"auto"}var Dn=I(Im()),gs=I(0);function vs(){document.documentElement.dataset.theme=Dn.value,gs.value+=1}function Rl(){Dn.
value=Ll[(Ll.indexOf(Dn.value)+1)%Ll.length],localStorage.setItem(oc,Dn.value),vs()}matchMedia("(prefers-color-scheme: l\
ight)").addEventListener("change",vs);vs();function nr(e){let t=document.createElement("i");t.style.color=`var(--${e})`,
document.body.append(t);let n=getComputedStyle(t).color;return t.remove(),n}var ut=class extends Error{constructor(n,r){super(n);this.at=r}at},lc={pi:Math.PI,e:Math.E},ic=180/Math.PI,Qe=e=>({least:1,
most:1,call:e}),sc=e=>({least:2,most:2,call:e}),_s=e=>({least:1,most:1/0,call:e}),ys={abs:Qe(Math.abs),acos:Qe(Math.acos),
asin:Qe(Math.asin),atan:Qe(Math.atan),atan2:sc(Math.atan2),ceil:Qe(Math.ceil),cos:Qe(Math.cos),deg:Qe(e=>e*ic),exp:Qe(Math.
exp),floor:Qe(Math.floor),hypot:_s(Math.hypot),log:Qe(Math.log),log10:Qe(Math.log10),max:_s(Math.max),min:_s(Math.min),mod:sc(
(e,t)=>e-t*Math.floor(e/t)),rad:Qe(e=>e/ic),round:Qe(Math.round),sign:Qe(Math.sign),sin:Qe(Math.sin),sqrt:Qe(Math.sqrt),
tan:Qe(Math.tan)},ks=Object.keys(ys),bs=/\s*(?:(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+(?:[eE][-+]?\d+)?)|([A-Za-z_]\w*)|([-+*/%^()[\],]))/y,
xs=/\s*(\/\d+\/\d+\/[A-Za-z_]\w*(?:\/\w+)?)\./y,ws=500,ac=50,Vm=e=>e===void 0||e.kind==="sign"&&e.text!==")"&&e.text!=="\
]";function zm(e){let t=[],n=0;for(;e.slice(n).trim()!=="";){let r=n+(e.slice(n).length-e.slice(n).trimStart().length);xs.
lastIndex=bs.lastIndex=n;let o=Vm(t.at(-1))?xs.exec(e):null,l=o??bs.exec(e);if(!l)throw new ut(`'${[...e.slice(r)][0]}' \
does not belong in a formula`,r);let[,a,c,d]=l,m=o?"topic":a?"number":c?"name":"sign";t.push({kind:m,text:a??c??d??"",at:r}),
n=o?xs.lastIndex:bs.lastIndex}return t.push({kind:"end",text:"",at:e.length}),t}var Hm={"+":(e,t)=>e+t,"-":(e,t)=>e-t},Um={
"*":(e,t)=>e*t,"/":(e,t)=>e/t,"%":(e,t)=>e%t},Ss=class{constructor(t){this.all=t}all;uses=[];next=0;depth=0;whole(){let t=this.
sum();return this.token.kind!=="end"&&this.fail(`expected an operator before '${this.token.text}'`),t}get token(){return this.
all[this.next]}fail(t,n=this.token.at){throw new ut(t,n)}accept(t){return this.token.kind!=="sign"||this.token.text!==t?
!1:(++this.next,!0)}expect(t,n){this.accept(t)||this.fail(`expected '${t}' ${n}`)}chain(t,n){let r=n();for(let o=this.operator(
t);o;o=this.operator(t)){let l=r,a=n(),c=o;r=d=>c(l(d),a(d))}return r}operator(t){let{kind:n,text:r}=this.token;return n!==
"sign"||!Object.hasOwn(t,r)?null:(++this.next,t[r])}sum(){++this.depth>ac&&this.fail("too many parentheses");let t=this.
chain(Hm,()=>this.chain(Um,()=>this.signed()));return--this.depth,t}signed(){let t=!1;for(;;)if(this.accept("-"))t=!t;else if(!this.
accept("+"))break;let n=this.power();return t?r=>-n(r):n}power(){let t=this.primary();if(!this.accept("^"))return t;++this.
depth>ac&&this.fail("too many powers");let n=this.signed();return--this.depth,r=>t(r)**n(r)}primary(){let{kind:t,text:n,
at:r}=this.token;if(this.accept("(")){let o=this.sum();return this.expect(")","for the '(' before"),o}if(t==="end"&&this.
fail("the formula ends too early: a number or a field is missing"),t==="sign"&&this.fail(`expected a number or a field b\
efore '${n}'`),++this.next,t==="number"){let o=Number(n);return()=>o}return t==="topic"?this.fieldOf(n):this.accept("(")?
this.call(n,r):this.named(n,r)}fieldOf(t){let{kind:n,text:r,at:o}=this.token;return n!=="name"&&this.fail(`expected a fi\
eld of ${t}`),++this.next,this.field(t,r,o)}named(t,n){let r=Object.hasOwn(lc,t)?lc[t]:void 0,o=this.token.kind==="sign"&&
this.token.text==="[";return r!==void 0&&!o?()=>r:this.field(null,t,n)}field(t,n,r){let o=this.accept("[")?this.element():
null;return this.uses.push({topic:t,name:n,element:o,at:r}),l=>l(n,o,t)}element(){let{kind:t,text:n}=this.token;return(t!==
"number"||!/^\d+$/.test(n))&&this.fail("expected the number of an array element, as in [0]"),++this.next,this.expect("]",
"after the number of the element"),Number(n)}call(t,n){let r=Object.hasOwn(ys,t)?ys[t]:void 0;r||this.fail(`there is no \
function '${t}'; there are ${ks.join(", ")}`,n);let o=this.arguments();if(o.length<r.least||o.length>r.most){let l=r.most===
1/0?"at least one value":r.least===1?"one value":`${r.least} values`;this.fail(`${t} takes ${l}, not ${o.length}`,n)}return l=>r.
call(...o.map(a=>a(l)))}arguments(){if(this.accept(")"))return[];let t=[this.sum()];for(;this.accept(",");)t.push(this.sum());
return this.expect(")","after the values of the function"),t}};function $o(e){if(e.length>ws)throw new ut(`a formula has\
 at most ${ws} characters`,ws);let t=new Ss(zm(e));return{formula:t.whole(),uses:t.uses}}var uc="mavloom-keys",Br=I(localStorage.getItem(uc)!=="off");function cc(){Br.value=!Br.value,localStorage.setItem(uc,Br.
value?"on":"off")}var Il=new Map;function Vl(e){for(let[t,n]of Object.entries(e))Il.set(t,n);return()=>{for(let[t,n]of Object.
entries(e))Il.get(t)===n&&Il.delete(t)}}function jr(e,t=10){requestAnimationFrame(()=>{let n=document.querySelector(e);n?
n.focus({preventScroll:!0}):t>0&&jr(e,t-1)})}function Ms(){let e=ge.value,t=document.activeElement?.closest("aside.messa\
ge")!=null;if(ge.value=null,!t||e===null)return;(document.querySelector(`[data-row$="${CSS.escape(` ${e}`)}"]`)??document.
querySelector("main .scroller"))?.focus()}var Wm={1:()=>{He.value="overview"},2:()=>{He.value="messages"},3:()=>{He.value=
"plots"},"?":()=>{Mt.value=!Mt.value},t:Rl,"/":()=>{He.value="messages",jr("#search")}};function fc(e){return e instanceof
HTMLElement?e instanceof HTMLInputElement&&e.type!=="checkbox"||e instanceof HTMLTextAreaElement||e instanceof HTMLSelectElement:
!1}function Gm(e){Mt.value?Mt.value=!1:fc(e)?e.blur():Ms()}function pc(e){if(e.ctrlKey||e.metaKey||e.altKey||e.defaultPrevented)
return;if(e.key==="Escape")return e.preventDefault(),Gm(e.target);if(fc(e.target)||!Br.value&&e.key.length===1||e.key===
" "&&e.target instanceof HTMLButtonElement)return;let t=Il.get(e.key)??Wm[e.key];!t||Mt.value&&e.key!=="?"||(e.preventDefault(),
t(e))}var Bm=[["Everywhere",[["1 2 3","Overview, Messages, Plots"],["/","search messages"],["t","light, dark, as the system"],
["Esc","close, leave a field"],["?","this list"]]],["Messages",[["j k, \u2193 \u2191","next, previous row"],["Enter","op\
en the row"],["f","freeze the table"],["c","compare with the frozen state"],["Tab","to the open message: its close butto\
n, then its fields; Enter plots one"]]],["Plots",[["Space","stop, follow again"],["+ \u2212","zoom"],["\u2190 \u2192","e\
arlier, later"],["0","follow the latest"],["a","add a formula"]]]];function jm({title:e,keys:t}){return s("section",{children:[
s("h3",{children:e}),s("dl",{class:"keys",children:t.map(([n,r])=>[s("dt",{children:s("kbd",{children:n})},n),s("dd",{children:r},
r)])})]})}var qm=()=>s("p",{children:["Formulas have fields, array elements such as ",s("code",{children:"voltages[0]"}),
", ",s("code",{children:"+ - * / % ^ ( )"}),","," ",s("code",{children:"pi"}),", ",s("code",{children:"e"})," and"," ",ks.
map((e,t)=>[t>0?", ":"",s("code",{children:e},e)]),". A field of another topic has its name before it, as in ",s("code",
{children:"alt - /2/1/VFR_HUD.alt"}),": the latest value counts."]});function dc(){Mt.value=!1}function mc(){let e=an(null);
return tt(()=>{Mt.value&&!e.current?.open&&e.current?.showModal(),!Mt.value&&e.current?.open&&e.current?.close()},[Mt.value]),
s("dialog",{ref:e,"aria-labelledby":"help-title",onClose:dc,children:[s("header",{children:[s("h2",{id:"help-title",children:"\
Keys"}),s("button",{class:"quiet",onClick:dc,"aria-label":"Close",children:s(ue,{name:"close"})})]}),s("div",{class:"gro\
ups",children:Bm.map(([t,n])=>s(jm,{title:t,keys:n},t))}),s("label",{class:"check",children:[s("input",{type:"checkbox",
checked:Br.value,onChange:cc})," Keys of one letter work"]}),s(qm,{}),s("p",{class:"dim",children:[To.value," \xB7 ",s("\
a",{href:"licences.txt",children:"Licences of what this page contains"})]})]})}var zl=4,Ym=new TextDecoder;function hc(e){return e<=Number.MAX_SAFE_INTEGER&&e>=Number.MIN_SAFE_INTEGER?Number(e):e}var Km={
int8:(e,t)=>e.getInt8(t),uint8:(e,t)=>e.getUint8(t),int16:(e,t)=>e.getInt16(t,!0),uint16:(e,t)=>e.getUint16(t,!0),int32:(e,t)=>e.
getInt32(t,!0),uint32:(e,t)=>e.getUint32(t,!0),int64:(e,t)=>hc(e.getBigInt64(t,!0)),uint64:(e,t)=>hc(e.getBigUint64(t,!0)),
float32:(e,t)=>e.getFloat32(t,!0),float64:(e,t)=>e.getFloat64(t,!0)},Ts=class{constructor(t){this.data=t}data;at=zl;field(t){
if(t.length===null)return this.scalar(t.type);let n=new Array(t.length);for(let r=0;r<t.length;++r)n[r]=this.scalar(t.type);
return n}scalar(t){let n=Hu(t);if(this.at=zl+Math.ceil((this.at-zl)/n)*n,t==="string")return this.text();let r=Km[t](this.
data,this.at);return this.at+=n,r}text(){let t=this.data.getUint32(this.at,!0),n=new Uint8Array(this.data.buffer,this.data.
byteOffset+this.at+4,Math.max(0,t-1));return this.at+=4+t,Ym.decode(n)}};function Hl(e,t){if(t.byteLength<zl||t.getUint8(
1)!==1)throw new RangeError("not a little-endian CDR message");let n=new Ts(t);return e.fields.map(r=>n.field(r))}function gc(e,t,n){
let r=e[t],o=Array.isArray(r)?r[n??0]:r;return typeof o=="string"||o===void 0?NaN:Number(o)}var Ul=I(0),As=null;function Wl(){Ul.value,jt.value;let e=ge.value;if(e===null)return null;let t=As?.topic===e?As:null,n=t?.
schema??st.get(e)?.schema;if(!n)return null;let r={topic:e,schema:n,message:null,timeUs:t?.timeUs??0,error:""};if(!t)return r;
try{return{...r,message:Hl(n,t.data)}}catch(o){return{...r,error:String(o)}}}function vc(){ze(()=>{let e=ge.value;if(!(e===
null||!Sl.value))return Vr(e,(t,n)=>{let r=st.get(e)?.schema;r&&(As={topic:e,schema:r,data:t,timeUs:n},kt(Ul))})})}var Ee=I(null),Lt=I(!1);function Gl(){Ee.value={at:Xn(),opened:Wl(),rows:new Map(gt)},Lt.value=!1}function Es(){Ee.value=
null,Lt.value=!1}function Ns(){Ee.value===null&&Gl(),Lt.value=!Lt.value}var bc=()=>Ee.value&&!Lt.value?Ee.value.rows:gt;
function Ps(e){let t=Ee.value;return t&&!Lt.value?ps(e,t.at-e.seenAt)?"silent":"":(t?!t.rows.has(e.key):e.newAt>0&&Xn()-
e.newAt<10)?"new":ps(e)?"silent":""}var Os=e=>Ee.value&&!Lt.value?Math.max(0,Ee.value.at-e.seenAt):Ur(e),Ro=e=>Nl(e,Os(e));
function Zm(e){let t=e.toLowerCase().split(/\s+/).filter(o=>o!==""),n=t.filter(o=>/^\d+\/\d*$/.test(o)),r=t.filter(o=>!n.
includes(o));return o=>{let l=`${o.sys}/${o.comp}`;return n.every(c=>c.endsWith("/")?l.startsWith(c):l===c)&&r.every(c=>Jm(
o).includes(c))}}var _c=new WeakMap;function Jm(e){let t=_c.get(e);if(t!==void 0)return t;let n=`${e.topic} ${e.link??""}\
 ${e.id}`.toLowerCase();return _c.set(e,n),n}var qr=e=>e===0?0:Number(e.toPrecision(2)),Xm={source:e=>e.sys*256+e.comp,id:e=>e.
id,hz:e=>qr(Ro(e)),count:e=>qr(e.count),bytes:e=>qr(e.bytes),share:e=>qr(e.share),gaps:e=>qr(e.gap_max_ms??-1),jitter:e=>qr(
e.jitter_ms??-1),age:e=>Math.floor(Ur(e))},Qm=(e,t)=>e.sys-t.sys||e.comp-t.comp||Lo(e.name,t.name)||eh(e.instance,t.instance)||
Lo(e.key,t.key),Lo=(e,t)=>e<t?-1:e>t?1:0,eh=(e,t)=>Number(e)-Number(t)||Lo(String(e??""),String(t??""));function th(e){let t=Xm[e];
return t?(n,r)=>t(n)-t(r):e==="link"?(n,r)=>Lo(n.link??"",r.link??""):(n,r)=>Lo(n.name,r.name)}function xc(e,t,n){let r=th(
n.column),o=n.isDown?-1:1;return[...e].filter(Zm(t)).sort((l,a)=>o*r(l,a)||Qm(l,a))}var wc=6;function nh(e){let t=an(null),[n,r]=Au({top:0,height:800,row:26});Dr(()=>{let l=t.current;if(!l)return;let a=()=>{
let d=parseFloat(getComputedStyle(l).getPropertyValue("--row"))||26;r({top:l.scrollTop,height:l.clientHeight,row:d})},c=new ResizeObserver(
a);return c.observe(l),l.addEventListener("scroll",a,{passive:!0}),()=>{c.disconnect(),l.removeEventListener("scroll",a)}},
[]);let o=Math.max(0,Math.min(e,Math.floor(n.top/n.row)-wc));return{scroller:t,row:n.row,first:o,end:Math.min(e,Math.ceil(
(n.top+n.height)/n.row)+wc)}}function rh({columns:e,sort:t,onSort:n}){let r=t?.isDown?"descending":"ascending";return s(
"thead",{children:s("tr",{"aria-rowindex":1,children:e.map(o=>s("th",{scope:"col",title:o.help,class:`c-${o.key} ${o.isNumber?
"number":""}`,"aria-sort":t?.column===o.key?r:void 0,children:n&&o.label!==""?s("button",{onClick:()=>n(o.key),children:o.
label}):o.label},o.key))})})}var yc=({rows:e,row:t})=>e<=0?null:s("tr",{class:"spacer","aria-hidden":"true",children:s("\
td",{style:{height:`${e*t}px`}})});function oh({current:e,rows:t,keyOf:n},r){tt(()=>{let o=r.scroller.current,l=t.findIndex(
d=>n(d)===e);if(!o||l<0)return;let a=l*r.row,c=o.clientHeight-2*r.row;a<o.scrollTop?o.scrollTop=a:a>o.scrollTop+c&&(o.scrollTop=
a-c)},[e])}function lh({columns:e,row:t}){return s(oe,{children:e.map(n=>s("td",{class:`c-${n.key} ${n.isNumber?"number":
""}`,children:n.cell(t)},n.key))})}function Bl(e){let{caption:t,columns:n,rows:r,keyOf:o,classOf:l,current:a}=e,c=nh(r.length),
{scroller:d,row:m,first:g,end:_}=c,x=v=>`${l?.(v)??""} ${o(v)===a?"current":""}`;return oh(e,c),s("div",{class:"scroller",
ref:d,tabIndex:-1,children:s("table",{"aria-rowcount":r.length+1,children:[s("caption",{class:"hidden",children:t}),s("c\
olgroup",{children:n.map(v=>s("col",{class:`c-${v.key}`},v.key))}),s(rh,{...e}),s("tbody",{children:[s(yc,{rows:g,row:m}),
r.slice(g,_).map((v,k)=>s("tr",{"aria-rowindex":g+k+2,class:x(v),children:lh({columns:n,row:v})},o(v))),s(yc,{rows:r.length-
_,row:m})]})]})})}var ih={degE7:[1e-7,"\xB0",7],cdeg:[.01,"\xB0",2],rad:[180/Math.PI,"\xB0",2],"rad/s":[180/Math.PI,"\xB0/s",2],mm:[.001,"\
m",3],cm:[.01,"m",2],"cm/s":[.01,"m/s",2],"mm/s":[.001,"m/s",3],mV:[.001,"V",3],cV:[.01,"V",2],cA:[.01,"A",2],mA:[.001,"\
A",3],cdegC:[.01,"\xB0C",2],"c%":[.01,"%",2],"d%":[.1,"%",1]},Sc=e=>String(Math.floor(e)).padStart(2,"0"),sh=e=>`${Math.
floor(e/3600)}:${Sc(e/60%60)}:${Sc(e%60)}`;function kc(e){return e>1e9?new Date(e*1e3).toISOString().slice(0,19).replace(
"T"," "):sh(e)}function Mc(e,t){let n=Number(e);if(!Number.isFinite(n))return"";if(t==="us"&&n>=1e6)return kc(n/1e6);if(t===
"ms"&&n>=1e4)return kc(n/1e3);let r=ih[t];if(!r)return"";let[o,l,a]=r;return`${Math.abs(n*o)>=1e6?Gr(n*o):$e(n*o,a)}${l.
startsWith("\xB0")&&l!=="\xB0C"&&l!=="\xB0/s"?"":" "}${l}`}function ah(e,t){let[,n,r,o]=e.match(/^(U?)INT(8|16|32|64)_(MAX|MIN)$/)??[];if(r===void 0)return uh(e,t)??(e.toLowerCase()===
"nan"?NaN:Number(e));let l=Number(r)-(n?0:1);return o==="MAX"?2**l-1:n?0:-(2**l)}var uh=(e,t)=>[...t.entries??[]].find(([
,n])=>n===e)?.[0];function Fs(e,t,n){if(t===""||e===void 0)return!1;let r=ah(t,n);return Number(e)===r||Number.isNaN(r)&&
Number.isNaN(Number(e))}function jl(e,t,n){let r=e.invalid;if(r===""||e.type==="string")return!1;let o=Array.isArray(t)?
t:[t],l=o[n??0];if(!r.startsWith("("))return Fs(l,r,e);let a=r.slice(1,-1);return a.endsWith(":")?Fs(o[0],a.slice(0,-1),
e):Fs(l,a.includes(",")?a.split(",")[n??0]??"":a,e)}var $s="application/x-mavloom-series",Cs=16,ql=e=>e.type.startsWith("float"),Ds=I(new Set);function ch(e){let t=Ee.value?.
opened;return t?.topic===e.topic&&t.schema===e.schema?t.message:null}function fh(e,t){return[...e.entries??[]].filter(([
r])=>r!==0&&Math.floor(t/r)%2===1).map(([,r])=>Ac(r,e))}function Ac(e,t){let n=[...t.entries?.values()??[]];if(n.length<
2)return e;let r=0;for(;n.every(o=>o[r]===n[0]?.[r]&&r<o.length);)++r;return e.slice(n[0]?.lastIndexOf("_",r-1)===-1?0:(n[0]?.
lastIndexOf("_",r-1)??-1)+1)}var Ec=({field:e,whole:t,element:n})=>jl(e,t,n);function Nc(e){let{field:t,raw:n}=e;if(typeof n==
"string")return"";let r=t.entries?.get(Number(n));return r!==void 0?Ac(r,t):Ec(e)?"unknown":t.isFlags?fh(t,Number(n)).join(
", "):Mc(n,t.unit)}var Pc=({name:e})=>s(oe,{children:e.split(/(?<=_)/).flatMap((t,n)=>n===0?[t]:[s("wbr",{},n),t])});function ph({
field:e,raw:t,formula:n}){let r=()=>Oo(Wr(ge.value??"",n));return s("button",{class:"value mono",title:`Plot ${n}`,"aria\
-label":`Plot ${n}, ${Co(t,ql(e))}`,onClick:r,children:Co(t,ql(e))})}var Oc=36,Tc=()=>Ee.value?5:4;function dh({field:e,
raw:t,before:n}){if(!Ee.value)return null;let r=n!==void 0&&!Object.is(n,t);return s("td",{class:`number mono ${r?"chang\
ed":"dim"}`,children:n===void 0?"":Co(n,ql(e))})}function mh(e){let{field:t,raw:n,formula:r}=e,o=Nc(e);return s(oe,{children:[
s("td",{class:"number",children:s(ph,{field:t,raw:n,formula:r})}),s(dh,{...e}),s("td",{class:"dim f-unit",children:Ec(e)?
"":t.unit}),s("td",{class:"meaning",children:o.length>Oc?"":o})]})}function Fc(e){let{field:t,raw:n,element:r}=e,o=r===null?
t.name:`${t.name}[${r}]`,l=typeof n=="string",a=l?n:Nc(e);return s(oe,{children:[s("tr",{draggable:!l,onDragStart:d=>{d.
dataTransfer?.setData($s,JSON.stringify(Wr(ge.value??"",o))),d.dataTransfer?.setData("text/plain",o)},class:r===null?"":
"element",children:[s("th",{scope:"row",children:r===null?s(Pc,{name:t.name}):`[${r}]`}),l?s("td",{class:"text",colSpan:Tc()-
1,children:n}):s(mh,{...e,formula:o})]}),!l&&a.length>Oc&&s("tr",{class:"more",children:s("td",{colSpan:Tc(),children:a})})]})}
function hh(e){let t=new Set(Ds.value);t.delete(e)||t.add(e),Ds.value=t}function gh({field:e,all:t,isOpen:n,name:r}){let o=t.
slice(0,Cs).map(a=>Co(a,ql(e))),l=`${t.length} elements`;return s("tr",{class:"array",children:[s("th",{scope:"row",children:s(
Pc,{name:e.name})}),s("td",{colSpan:Ee.value?2:1,class:"dim",children:t.length<=Cs?l:s("button",{class:"link","aria-expa\
nded":n,onClick:()=>hh(r),children:l})}),s("td",{class:"dim f-unit",children:e.unit}),s("td",{class:"meaning mono cut",children:n?
"":`${o.join(" ")} \u2026`})]})}function vh({field:e,all:t,before:n}){let r=`${ge.value} ${e.name}`,o=t.length<=Cs||Ds.value.
has(r),l=Array.isArray(n)?n:[];return s(oe,{children:[s(gh,{field:e,all:t,isOpen:o,name:r}),o&&t.map((a,c)=>s(Fc,{field:e,
raw:a,whole:t,element:c,before:l[c]},c))]})}function _h({field:e,raw:t,before:n}){return Array.isArray(t)?s(vh,{field:e,
all:t,before:n}):s(Fc,{field:e,raw:t,whole:t,before:n,element:null})}var bh=()=>s("thead",{class:Ee.value?"":"hidden",children:s(
"tr",{children:[s("th",{scope:"col",children:"Field"}),s("th",{scope:"col",class:"number",children:"Value"}),Ee.value&&s(
"th",{scope:"col",class:"number",children:"Then"}),s("th",{scope:"col",class:"f-unit",children:"Unit"}),s("th",{scope:"c\
ol",children:"Meaning"})]})});function xh({now:e}){let t=ch(e),{schema:n,message:r}=e;return r?s("table",{class:`fields ${Ee.
value?"compared":""}`,children:[s("caption",{class:"hidden",children:["Fields of ",n.name]}),s("colgroup",{children:[s("\
col",{class:"f-name"}),s("col",{class:"f-value"}),Ee.value&&s("col",{class:"f-value"}),s("col",{class:"f-unit"}),s("col",
{})]}),s(bh,{}),s("tbody",{children:n.fields.map((o,l)=>s(_h,{field:o,raw:r[l],before:t?.[l]},o.name))})]}):s("p",{class:"\
empty",children:e.error||"No message has come yet."})}var wh=()=>s("p",{class:"empty",children:jt.value>0&&mt.value?"Not\
hing with this name was heard.":"Waiting for the server."}),yh=({topic:e})=>s("header",{children:[s("h3",{children:s("sp\
an",{class:"mono cut",title:e,children:e})}),s("button",{class:"quiet end",onClick:Ms,"aria-label":"Close the message",title:"\
Close (Esc)",children:s(ue,{name:"close"})})]});function Yl({hz:e}){Ul.value,ht.value;let t=Wl(),n=ge.value??"";return s(
"aside",{class:"message","aria-label":`Message ${n}`,children:[s(yh,{topic:n}),s("p",{class:"dim number about",children:[
t&&`id ${t.schema.id}`,e!==null&&s("span",{children:[Tt(e)," /s"]}),t&&t.timeUs>0&&s("span",{children:["at ",$l(t.timeUs)]})]}),
s("div",{class:"scroller",tabIndex:-1,children:t?s(xh,{now:t}):s(wh,{})}),s("p",{class:"hint dim",children:He.value==="p\
lots"?"Click a number, or drag it into a plot.":"Click a number to plot it."})]})}function Kl({text:e}){let t=Xu();return xn.version.value===0?s("p",{class:"empty",children:"The server has not reported \
yet."}):t.length===0?s("p",{class:"empty",children:e}):s("ul",{class:"empty hints",children:t.map(n=>s("li",{children:[n,
"."]},n))})}var Kr=I(null),dn=St(()=>(El.version.value,Ee.value,Lt.value,qt.value.column==="age"&&ht.value,xc(bc().values(),cn.value,
qt.value)));function Sh(e){Kr.value=e.key,ge.value=ge.value===e.topic?null:e.topic}function kh({row:e}){let t=e.key===(Kr.
value??dn.value[0]?.key);return s("button",{class:"name mono","data-row":e.key,tabIndex:t?0:-1,"aria-expanded":ge.value===
e.topic,onClick:()=>Sh(e),onFocus:()=>{Kr.value=e.key},children:[e.name,e.instance!==null&&s("span",{class:"instance",children:[
"/",e.instance]})]})}function Mh(e){let t=Ps(e);return t===""?null:s("span",{class:`mark ${t}`,children:t})}var Th=({row:e})=>{
let t=Ee.value?.rows.get(e.key);if(!t)return s(oe,{children:"\u2013"});let n=Math.abs(t.hz-Nl(e))>.1*Math.max(t.hz,e.hz,
1);return s("span",{class:n?"changed":"dim",children:Tt(t.hz)})},Ah=({row:e})=>{let t=e.count-(Ee.value?.rows.get(e.key)?.
count??0);return s("span",{class:t===0?"dim":"",children:t>0?`+${at(t)}`:at(t)})},Eh=e=>e.gap_min_ms==null?"\u2013":`${$e(
e.gap_min_ms,0)} \u2013 ${$e(e.gap_max_ms,0)}`,Dc={mark:{key:"mark",label:"",cell:Mh},link:{key:"link",label:"Link",cell:e=>s(
"span",{class:"cut",title:e.link??"",children:e.link??"\u2013"})},source:{key:"source",label:"From",help:"system/compone\
nt",cell:e=>s("span",{class:"mono",children:[e.sys,"/",e.comp]})},name:{key:"name",label:"Message",cell:e=>s(kh,{row:e})},
id:{key:"id",label:"Id",isNumber:!0,cell:e=>e.id},hz:{key:"hz",label:"Rate /s",isNumber:!0,cell:e=>Tt(Ro(e))},before:{key:"\
before",label:"Then /s",help:"the rate in the frozen state",isNumber:!0,cell:e=>s(Th,{row:e})},count:{key:"count",label:"\
Count",isNumber:!0,cell:e=>at(e.count)},more:{key:"more",label:"Since",help:"messages since the frozen state",isNumber:!0,
cell:e=>s(Ah,{row:e})},bytes:{key:"bytes",label:"Bytes",isNumber:!0,cell:e=>Fo(e.bytes)},share:{key:"share",label:"Share\
 %",help:"of the link's bytes",isNumber:!0,cell:e=>$e(e.share*100,1)},gaps:{key:"gaps",label:"Gaps ms",help:"shortest an\
d longest time between two messages",isNumber:!0,cell:Eh},jitter:{key:"jitter",label:"Jitter ms",isNumber:!0,cell:e=>$e(
e.jitter_ms,1)},age:{key:"age",label:"Age",help:"since the latest message",isNumber:!0,cell:e=>Yt(Os(e))}},Nh={hz:["hz",
"before"],count:["count","more"],bytes:[],share:[],gaps:[],jitter:[]};function Ph(){let e=er.filter(r=>fn.value.includes(
r)),t=e.toSpliced(e.indexOf("name")+1,0,"mark");return(Lt.value?t.flatMap(r=>Nh[r]??[r]):t).flatMap(r=>Dc[r]??[])}function Oh(e){
if(!er.includes(e))return;let t=["source","name","link","id"].includes(e);qt.value=qt.value.column===e?{column:e,isDown:!qt.
value.isDown}:{column:e,isDown:!t}}function Fh(){let e=t=>{let n=fn.value.includes(t);fn.value=er.filter(r=>r===t?!n:fn.
value.includes(r))};return s("details",{class:"chooser",children:[s("summary",{children:"Columns"}),s("div",{class:"menu",
children:er.filter(t=>t!=="name").map(t=>s("label",{class:"check",children:[s("input",{type:"checkbox",checked:fn.value.
includes(t),onChange:()=>e(t)})," ",Dc[t]?.label]},t))})]})}function Ch(){let e=Ee.value;return s("span",{class:"group",
children:[s("button",{"aria-pressed":e!==null,onClick:()=>e?Es():Gl(),title:"Freeze the table (f)",children:[s(ue,{name:e?
"play":"pause"}),e?"Thaw":"Freeze"]}),e&&s("button",{"aria-pressed":Lt.value,onClick:Ns,title:"Live values beside the fr\
ozen ones (c)",children:"Compare"})]})}function Dh(){El.version.value;let e=dn.value.reduce((n,r)=>n+Ro(r),0),t=Ee.value===
null?"":Lt.value?" \xB7 live, compared":" \xB7 frozen";return s("span",{class:"summary dim number",role:"status","aria-l\
ive":"off",children:[at(dn.value.length),dn.value.length<gt.size&&` of ${at(gt.size)}`," rows \xB7"," ",Math.round(e).toLocaleString(
"en-US")," /s",t]})}function $h(){return s("div",{class:"toolbar",children:[s("input",{id:"search",type:"search",placeholder:"\
Search: 1/1 battery","aria-label":"Search messages",value:cn.value,autocomplete:"off",spellcheck:!1,onInput:e=>{cn.value=
e.currentTarget.value},onKeyDown:e=>{(e.key==="Enter"||e.key==="ArrowDown")&&Zl(0)}}),s(Ch,{}),s(Fh,{}),s(Dh,{})]})}function Zl(e){
let t=dn.value[Math.max(0,Math.min(dn.value.length-1,e))];t&&(Kr.value=t.key,jr(`[data-row="${CSS.escape(t.key)}"]`))}var Cc=()=>dn.
value.findIndex(e=>e.key===Kr.value),Yr=e=>()=>Zl(Cc()<0?0:Cc()+e),Lh={j:Yr(1),ArrowDown:Yr(1),k:Yr(-1),ArrowUp:Yr(-1),PageDown:Yr(
20),PageUp:Yr(-20),Home:()=>Zl(0),End:()=>Zl(1/0),f:()=>Ee.value?Es():Gl(),c:Ns};function $c(){tt(()=>El.use(),[]),tt(()=>xn.
use(),[]),Dr(()=>Vl(Lh),[]),ht.value;let e=dn.value.find(t=>t.topic===ge.value);return s(oe,{children:[s("h2",{class:"hi\
dden",children:"Messages"}),s("div",{class:"list",children:[s($h,{}),s(Bl,{caption:"Messages, a row for each sender, mes\
sage and instance",columns:Ph(),rows:dn.value,keyOf:t=>t.key,current:Kr.value,sort:qt.value,onSort:Oh,classOf:t=>`${Ps(t)}\
 ${t.topic===ge.value?"open":""}`}),gt.size===0&&s(Kl,{text:"No message has come yet."}),gt.size>0&&dn.value.length===0&&
s("p",{class:"empty",children:"No message matches the search."})]}),ge.value!==null&&s(Yl,{hz:e?Ro(e):null})]})}var Ls=100;function Lc(e){return[e.sys===null?"":`${e.sys}${e.comp===null?"":`/${e.comp}`}`,e.link??""].filter(n=>n!=="").
join(" ")}function Rh({alarm:e}){let t=e.ended_us!==null,n=(t?(e.ended_us??0)/1e6:Xn())-e.since_us/1e6;return s("li",{class:t?
"over":e.severity,children:[s("span",{class:"severity",children:[s(ue,{name:t?"ended":e.severity}),t?"over":e.severity]}),
s("time",{class:"number dim",dateTime:new Date(e.since_us/1e3).toISOString(),children:$l(e.since_us)}),s("span",{class:"\
mono about",children:Lc(e)}),s("span",{class:"text",children:e.text}),s("span",{class:"lasted number dim",children:t?`la\
sted ${Yt(n)}`:`for ${Yt(n)}`})]})}function Ih({alarm:e}){return s("p",{class:"hidden",role:"status","aria-live":"polite",
children:e?`${e.severity}: ${Lc(e)} ${e.text}`:""})}var Vh=({number:e})=>e===0?null:s("li",{class:"note dim",children:[at(
e)," older ",e===1?"one has":"ones have"," left the list, which was full"]});function Rc(){Qn.version.value,ht.value;let e=[
...zr.value].sort((n,r)=>+(n.ended_us!==null)-+(r.ended_us!==null)||r.since_us-n.since_us),t=e.filter(n=>n.ended_us===null);
return s("section",{"aria-labelledby":"alarms",children:[s("h2",{id:"alarms",children:["Alarms ",s("span",{class:"dim",children:t.
length>0?`${t.length} now`:""})]}),s(Ih,{alarm:t[0]}),e.length===0&&(Qn.version.value===0?s("p",{class:"empty",children:"\
The server has not reported yet."}):s("p",{class:"empty",children:[s(ue,{name:"ended"}),"No alarm now, and none in the l\
ast ten minutes."]})),s("ul",{class:"alarms panel",hidden:e.length===0,children:[e.slice(0,Ls).map(n=>s(Rh,{alarm:n},n.id)),
e.length>Ls&&s("li",{class:"note dim",children:["and ",e.length-Ls," more"]}),s(Vh,{number:as.value})]})]})}var Ic=120,Rs=22;function zh({name:e}){xn.version.value;let t=No.get(e)?.rates??[],n=Math.max(1,...t),r=Ic-t.length+1,o=t.
map((l,a)=>`${r+a},${(Rs-1-l/n*(Rs-3)).toFixed(1)}`);return s("svg",{class:"trend",viewBox:`0 0 ${Ic} ${Rs}`,preserveAspectRatio:"\
none",role:"img","aria-label":`frames a second in the last minute, at most ${Math.round(n)}`,children:o.length>1&&s("pol\
yline",{points:o.join(" ")})})}var Hc=({loss:e})=>s("li",{title:e.help,children:[s("span",{children:e.name.replaceAll("_",
" ")}),s("b",{class:"number",children:at(e.count)}),e.help&&s("small",{children:e.help})]});function Hh({hop:e}){let t=fs(
e),n=Al(e);return n===0?s("p",{class:"fine",children:[s(ue,{name:"ended"}),"nothing lost"]}):s("div",{class:`losses ${t>
0?"error":""}`,children:[s("p",{children:[s(ue,{name:t>0?"error":"info"}),at(n)," lost",s("span",{class:"end",children:t>
0?`+${at(t)} in 10 s`:"none in the last 10 s"})]}),s("ul",{children:e.losses.map(r=>s(Hc,{loss:r},r.name))})]})}var Uh={
up:"up",down:"down",ended:"ended"};function Wh({link:e}){return s("li",{class:e.state,children:[s("span",{class:"link",title:e.
name,children:[s(ue,{name:Uh[e.state]}),s("span",{class:"mono cut",children:e.name}),e.state!=="up"&&` ${e.state}`]}),s(
"span",{class:"number dim",title:`${Fo(e.bytes_in)} in, ${Fo(e.bytes_out)} out`,children:[s("b",{children:Tt(e.hz_in)}),
" in ",s("b",{children:Tt(e.hz_out)})," out"]}),e.losses.length>0&&s("ul",{class:"losses",children:e.losses.map(t=>s(Hc,
{loss:t},t.name))})]})}var Vc=({name:e,hz:t,frames:n})=>s("div",{children:[s("dt",{children:e}),s("dd",{children:[s("b",
{children:Tt(t)}),s("span",{class:"unit",children:"/s"})]}),s("dd",{class:"dim",children:at(n)})]}),Uc=e=>e.state!=="up"&&
e.kind!=="station",Gh=e=>Uc(e)?"down":"not here";function Bh({hop:e}){let t=e.state==="up",n=e.name.endsWith(e.kind)?"":
e.kind;return s("header",{children:[s("h3",{children:[s(ue,{name:t?"up":"down"}),s("span",{class:"cut",title:e.name,children:e.
name})]}),s("span",{class:"end dim",children:[s("span",{class:"kind",children:n})," ",t?"":Gh(e)]})]})}function jh({hop:e}){
let t=`panel hop ${Uc(e)?"down":""} ${fs(e)>0?"losing":""}`;return s("li",{class:t,children:[s(Bh,{hop:e}),s(zh,{name:e.
name}),s("dl",{class:"rates",children:[s(Vc,{name:"in",hz:e.hz_in,frames:e.frames_in}),s(Vc,{name:"out",hz:e.hz_out,frames:e.
frames_out})]}),s(Hh,{hop:e}),e.hint&&s("p",{class:"hint",children:e.hint}),e.links.length>0&&s("ul",{class:"links",children:e.
links.map(n=>s(Wh,{link:n},n.name))})]})}var zc=({all:e})=>s("ol",{class:"hops",children:e.map((t,n)=>[n>0&&s("li",{class:"\
arrow","aria-hidden":"true",children:s(ue,{name:"arrow"})},`to ${t.name}`),s(jh,{hop:t},t.name)])});function Wc(){xn.version.
value;let e=Ml.value,t=1+e.findIndex(n=>n.kind==="station")||e.length;return s("section",{"aria-labelledby":"hops",children:[
s("h2",{id:"hops",children:["Hops"," ",s("span",{class:"dim",children:e.length>0&&`${t}, in the order in which frames pa\
ss them`})]}),e.length===0&&s("p",{class:"empty",children:"The server has not reported yet."}),s(zc,{all:e.slice(0,t)}),
t<e.length&&s(oe,{children:[s("h3",{class:"aside dim",children:"Beside them, reading along"}),s(zc,{all:e.slice(t)})]})]})}var qh=6,Yh={GPS_FIX_TYPE_NO_GPS:"no GPS",GPS_FIX_TYPE_NO_FIX:"no fix",GPS_FIX_TYPE_2D_FIX:"2D",GPS_FIX_TYPE_3D_FIX:"3D",
GPS_FIX_TYPE_DGPS:"DGPS",GPS_FIX_TYPE_RTK_FLOAT:"RTK float",GPS_FIX_TYPE_RTK_FIXED:"RTK fixed",GPS_FIX_TYPE_STATIC:"stat\
ic",GPS_FIX_TYPE_PPP:"PPP"};function Is(e){return!e||e.fix===null?"\u2013":Yh[e.fix]??Do(e.fix,"GPS_FIX_TYPE_")}var Gc=e=>[
"no GPS","no fix"].includes(Is(e)),Bc=e=>e?.heading_deg==null?"\u2013":String(Math.round(e.heading_deg)%360);function jc(e){
let t=[["TIMESYNC",e.round_trip_ms?.timesync],["PING",e.round_trip_ms?.ping],["command",e.round_trip_ms?.command]],[n,r]=t.
find(([,o])=>o!=null)??["",null];return r?{text:r.last.toFixed(1),help:`${n}: least ${r.least.toFixed(1)} ms, mean ${r.mean.
toFixed(1)} ms of ${r.count}`}:{text:"\u2013",help:"no TIMESYNC, PING or command has been answered"}}function Kh(e){cn.value=
`${Hr(e)} `,He.value="messages"}var qc=({armed:e})=>e===null?s("span",{class:"dim",children:"\u2013"}):s("span",{class:`\
pill ${e?"armed":""}`,children:e?"ARMED":"disarmed"}),Yc=e=>e<=15?"error":e<=30?"warning":"";function Kc({percent:e}){return e==
null?null:s("svg",{class:`gauge ${Yc(e)}`,viewBox:"0 0 100 10",preserveAspectRatio:"none","aria-hidden":"true",children:[
s("rect",{class:"empty",width:"100",height:"10"}),s("rect",{width:Math.max(0,Math.min(100,e)),height:"10"})]})}function Zc({
battery:e}){let t=e?.percent;if(t==null)return s(oe,{children:"\u2013"});let n=Yc(t);return s("span",{class:n,children:[
n!==""&&s(ue,{name:n}),Math.round(t)," %"]})}var Jc=({all:e})=>{if(e.length===0)return null;let t=["error","warning","in\
fo"].find(n=>e.some(r=>r.severity===n))??"info";return s("span",{class:`mark ${t}`,title:e.map(n=>n.text).join(`
`),children:[s(ue,{name:t}),e.length]})},Vs=({one:e})=>s("button",{class:"name",onClick:()=>Kh(e),title:"Show its messag\
es",children:[s("b",{class:"mono",children:Hr(e)})," ",Do(e.type,"MAV_TYPE_")]}),Jl=({name:e,title:t,children:n})=>s("di\
v",{class:"pair",title:t,children:[s("dt",{children:e}),s("dd",{children:n})]}),wn=({name:e,value:t,unit:n,help:r})=>s(Jl,
{name:e,title:r,children:[t,t!=="\u2013"&&s("span",{class:"unit",children:n})]});function Zh({battery:e}){return s(oe,{children:[
s(Jl,{name:"Battery",children:[s(Zc,{battery:e}),s(Kc,{percent:e?.percent})]}),s(wn,{name:"Voltage",value:$e(e?.voltage_v,
2),unit:"V"}),s(wn,{name:"Current",value:$e(e?.current_a,1),unit:"A"})]})}function Jh({position:e}){return s(oe,{children:[
s(wn,{name:"Height",help:"above home",value:$e(e?.relative_alt_m,1),unit:"m"}),s(wn,{name:"Speed",help:"over ground",value:$e(
e?.ground_speed_m_s,1),unit:"m/s"}),s(wn,{name:"Heading",value:Bc(e),unit:"\xB0"}),s(wn,{name:"Latitude",value:$e(e?.lat_deg,
6),unit:"\xB0"}),s(wn,{name:"Longitude",value:$e(e?.lon_deg,6),unit:"\xB0"}),s(wn,{name:"Altitude",help:"above mean sea \
level",value:$e(e?.alt_m,1),unit:"m"})]})}function Xh({one:e}){let{battery:t,gps:n,position:r}=e,o=jc(e);return s("dl",{
class:"figures",children:[s(Zh,{battery:t}),s(Jl,{name:"GPS",children:s("span",{class:Gc(n)?"warning":"",children:[Gc(n)&&
s(ue,{name:"warning"}),Is(n)]})}),s(Jl,{name:"Satellites",children:n?.satellites??"\u2013"}),s(wn,{name:"Round trip",help:o.
help,value:o.text,unit:"ms"}),s(Jh,{position:r})]})}function Qh({one:e}){let t=us(e);return s("article",{class:`panel ve\
hicle ${e.silent?"silent":""}`,children:[s("header",{children:[s("h3",{children:s(Vs,{one:e})}),s(Jc,{all:t}),s("span",{
class:"end dim",children:e.silent?s(oe,{children:[s(ue,{name:"lost"}),"silent for ",Yt(e.age_s)]}):`${Tt(e.hz)} /s`})]}),
s("p",{class:"mode",children:[s("strong",{children:e.mode??"\u2013"}),s(qc,{armed:e.armed}),s("span",{class:"end dim",children:[
Do(e.status,"MAV_STATE_")," \xB7 ",Do(e.autopilot,"MAV_AUTOPILOT_")]})]}),s(Xh,{one:e})]})}var eg=[{key:"vehicle",label:"\
Vehicle",cell:e=>s(Vs,{one:e})},{key:"marks",label:"Alarms",cell:e=>s(Jc,{all:us(e)})},{key:"mode",label:"Mode",cell:e=>e.
mode??"\u2013"},{key:"armed",label:"Armed",cell:e=>s(qc,{armed:e.armed})},{key:"percent",label:"Battery",isNumber:!0,cell:e=>s(
oe,{children:[s(Kc,{percent:e.battery?.percent}),s(Zc,{battery:e.battery})]})},{key:"voltage",label:"V",isNumber:!0,cell:e=>$e(
e.battery?.voltage_v,2)},{key:"fix",label:"GPS",cell:e=>Is(e.gps)},{key:"satellites",label:"Sats",isNumber:!0,cell:e=>e.
gps?.satellites??"\u2013"},{key:"height",label:"Height m",isNumber:!0,cell:e=>$e(e.position?.relative_alt_m,1)},{key:"sp\
eed",label:"m/s",isNumber:!0,cell:e=>$e(e.position?.ground_speed_m_s,1)},{key:"heading",label:"Heading",isNumber:!0,cell:e=>Bc(
e.position)},{key:"lat",label:"Latitude",isNumber:!0,cell:e=>$e(e.position?.lat_deg,6)},{key:"lon",label:"Longitude",isNumber:!0,
cell:e=>$e(e.position?.lon_deg,6)},{key:"trip",label:"Trip ms",help:"round trip",isNumber:!0,cell:e=>jc(e).text},{key:"r\
ate",label:"/s",help:"messages a second",isNumber:!0,cell:e=>Tt(e.hz)},{key:"age",label:"Age",isNumber:!0,cell:e=>Yt(e.age_s)}];
function tg({all:e}){return e.length===0?null:s("ul",{class:"others","aria-label":"Other components",children:[e.slice(0,
40).map(t=>s("li",{class:t.silent?"silent":"",children:[s(Vs,{one:t})," ",s("span",{class:"dim",children:t.silent?`silen\
t for ${Yt(t.age_s)}`:`${Tt(t.hz)} /s`})]},Hr(t))),e.length>40&&s("li",{class:"dim",children:["and ",e.length-40," more"]})]})}
var ng=I(null);function rg({all:e}){return e.length>qh?s(Bl,{caption:"Vehicles",columns:eg,rows:e,keyOf:Hr,current:ng.value,
classOf:t=>t.silent?"silent":""}):s("div",{class:"panels",children:e.map(t=>s(Qh,{one:t},Hr(t)))})}function Xc(){Tl.version.
value,ht.value;let e=kl.value.filter(cs).sort((n,r)=>n.sys-r.sys||n.comp-r.comp),t=e.filter(n=>n.silent).length;return s(
"section",{"aria-labelledby":"vehicles",children:[s("h2",{id:"vehicles",children:["Vehicles"," ",s("span",{class:"dim",children:[
e.length>0&&e.length,t>0&&`, ${t} silent`]})]}),e.length===0&&s(Kl,{text:"No vehicle has sent a HEARTBEAT yet."}),s(rg,{
all:e}),s(tg,{all:kl.value.filter(n=>!cs(n))})]})}function Qc(){return tt(()=>{let e=[Tl.use(),xn.use(),Qn.use()];return()=>e.forEach(t=>t())},[]),s(oe,{children:[s(Xc,{}),
s(Wc,{}),s(Rc,{})]})}var zs=2e4;function Io(e,t,n,r){for(;n<r;){let o=n+r>>1;e[o]<t?n=o+1:r=o}return n}var Xl=class{times=new Float64Array(2*
zs);values=new Float64Array(2*zs);first=0;end=0;get length(){return this.end-this.first}get latest(){return this.end>this.
first?this.values[this.end-1]:NaN}get latestTime(){return this.end>this.first?this.times[this.end-1]:-1/0}add(t,n){this.
end===this.times.length&&this.compact(),this.times[this.end]=t,this.values[this.end++]=n,this.length>zs&&++this.first}range(t,n){
let r=Math.max(this.first,Io(this.times,t,this.first,this.end)-1),o=Math.min(this.end,Io(this.times,n,this.first,this.end)+
2);return[this.times.subarray(r,o),this.values.subarray(r,o)]}clear(){this.first=this.end=0}compact(){this.times.copyWithin(
0,this.first,this.end),this.values.copyWithin(0,this.first,this.end),this.end-=this.first,this.first=0}};function og(e,t){
let n=[...Array(t.length+1).keys()];for(let r=0;r<e.length;++r){let o=[r+1];for(let l=0;l<t.length;++l)o.push(Math.min(o[l]+
1,n[l+1]+1,n[l]+(e[r]===t[l]?0:1)));n=o}return n[t.length]}function lg(e,t){let n=t.fields.filter(o=>o.type!=="string").
map(o=>({name:o.name,score:og(e.toLowerCase(),o.name)-(o.name.startsWith(e)?3:0)}));n.sort((o,l)=>o.score-l.score);let r=n[0];
return r&&r.score<=3?`; is it ${r.name}?`:`; it has ${t.fields.map(o=>o.name).join(", ")}`}function ig({name:e,element:t,
at:n},r){let o=r.fields[r.indexOf.get(e)??-1];if(!o)throw new ut(`${r.name} has no field ${e}${lg(e,r)}`,n);if(o.type===
"string")throw new ut(`${e} is text, not a number`,n);if(o.length!==null&&t===null)throw new ut(`${e} is an array: choos\
e an element, from ${e}[0] to ${e}[${o.length-1}]`,n);if(o.length===null&&t!==null)throw new ut(`${e} is not an array`,n);
if(t!==null&&t>=(o.length??0))throw new ut(`${e} has ${o.length} elements, the last is ${e}[${(o.length??1)-1}]`,n)}function sg(e,t,n,r){
let o=e.indexOf.get(n)??-1,l=e.fields[o],a=t[o];return l&&a!==void 0&&jl(l,a,r)?NaN:gc(t,o,r)}var Vo=class{constructor(t,n){
this.parsed=t;this.own=n;let r=new Set(t.uses.map(o=>o.topic??n));this.topics=r.size>0?[...r]:[n]}parsed;own;topics;latest=new Map;check(t){
for(let n of this.parsed.uses){let r=t(n.topic??this.own);r&&ig(n,r)}}take(t,n,r){return this.latest.set(t,{schema:n,message:Hl(
n,r)}),this.latest.size<this.topics.length?null:this.parsed.formula((o,l,a)=>{let c=this.latest.get(a??this.own);return c?
sg(c.schema,c.message,o,l):NaN})}};function ef(e,t,n){let[,r,o]=e.trim().match(/^(?:(\/\S+)\.)?(\w+)(?:\[\d+\])?$/)??[],
l=n(r??t);return l?.fields[l.indexOf.get(o??"")??-1]?.unit??""}function tf(e,t){try{return t||($o(e).uses.find(n=>n.topic!==
null)?.topic??"")}catch{return t}}function nf(e,t,n){try{let r=$o(e),o=r.uses.find(l=>l.topic===null&&t==="");return o?new ut(
`choose a topic, or write it here, as in /1/1/VFR_HUD.${o.name}`,o.at):(new Vo(r,t).check(n),null)}catch(r){if(r instanceof
ut)return r;throw r}}var Kt=I(0),Ql=e=>st.get(e)?.schema??null,Hs=class{constructor(t,n){this.topic=t;this.formula=n;this.attempt(()=>{let r=new Vo(
$o(n),t);this.evaluator=r,this.stopWanting=r.topics.map(o=>Vr(o,(l,a)=>this.take(r,o,l,a)))}),this.compile()}topic;formula;points=new Xl;error="";unit="";total=0;arrivedMs=0;evaluator=null;schemas=[];stopWanting=[];compile(){
let{evaluator:t}=this,n=t?.topics.map(Ql)??[];n.every((r,o)=>r===this.schemas[o])||(this.schemas=n,this.attempt(()=>{t?.
check(Ql),this.unit=ef(this.formula,this.topic,Ql),this.error=""}))}interrupt(){this.points.length>0&&!Number.isNaN(this.
points.latest)&&this.points.add(this.points.latestTime,NaN)}stop(){for(let t of this.stopWanting)t()}attempt(t){try{t()}catch(n){
this.error=n instanceof ut?n.message:String(n)}}take(t,n,r,o){this.compile();let l=Ql(n);if(!l||this.error!=="")return;let a=t.
take(n,l,r);if(a===null)return;let c=o/1e6;c<this.points.latestTime-5&&this.points.clear(),this.points.add(Math.max(c,this.
points.latestTime),a),++this.total,this.arrivedMs=performance.now(),kt(Kt)}},rr=new Map,or=e=>`${e.topic} ${e.formula}`,
yn=e=>rr.get(or(e));function ag(e){let t=new Set(e.map(or));for(let[n,r]of rr)t.has(n)||(r.stop(),rr.delete(n));for(let n of e)
rr.has(or(n))||rr.set(or(n),new Hs(n.topic,n.formula));kt(Kt)}function rf(){ze(()=>ag(pe.value.flat())),ze(()=>{jt.value,
rr.forEach(e=>e.compile())}),ze(()=>{mt.value||rr.forEach(e=>e.interrupt())})}var Rt=I(null),Us=new Map,of=0,lf=()=>pe.value.flat().reduce((e,t)=>e+(yn(t)?.total??0),0),sf=()=>Math.max(0,lf()-of);function ug(){
let e=-1/0;for(let t of pe.value.flat()){let n=yn(t);if(!n||n.points.length===0)continue;let r=Math.min((performance.now()-
n.arrivedMs)/1e3,pn.value/2);e=Math.max(e,n.points.latestTime+r)}return Number.isFinite(e)?e:Date.now()/1e3}function Zt(){
let e=ug();return Rt.value??{from:e-pn.value,to:e}}function lr(e=Zt()){if(Rt.value===null){of=lf();for(let t of pe.value.
flat()){let n=yn(t)?.points.range(-1/0,1/0);n&&Us.set(or(t),[n[0].slice(),n[1].slice()])}}Rt.value=e,kt(Kt)}function zo(){
Us.clear(),Rt.value=null,kt(Kt)}function mn(e,t=.5){let{from:n,to:r}=Zt(),o=Math.min(7200,Math.max(.05,(r-n)*e)),l=n+(r-
n)*t;lr({from:l-o*t,to:l+o*(1-t)})}function Ho(e){let{from:t,to:n}=Zt(),r=(n-t)*e;lr({from:t+r,to:n+r})}function ir(e,{from:t,
to:n}){let r=Rt.value===null?void 0:Us.get(or(e));if(!r)return yn(e)?.points.range(t,n)??[new Float64Array,new Float64Array];
let o=Math.max(0,Io(r[0],t,0,r[0].length)-1),l=Io(r[0],n,0,r[0].length)+2;return[r[0].subarray(o,l),r[1].subarray(o,l)]}
function af([e,t],n){if(e.length<=4*n)return[e,t];let r=[];for(let o=0;o<n;++o){let l=Math.floor(o*e.length/n),a=Math.floor(
(o+1)*e.length/n),c=l,d=l;for(let m=l;m<a;++m)t[m]>=t[c]||(c=m),t[m]<=t[d]||(d=m);for(let m of c<d?[c,d]:[d,c])r.push([e[m],
t[m]])}return[Float64Array.from(r,o=>o[0]),Float64Array.from(r,o=>o[1])]}function uf(e,t){let n=document.createElement("a");n.href=URL.createObjectURL(t),n.download=e,n.click(),setTimeout(()=>URL.
revokeObjectURL(n.href),1e4)}var cf=e=>`mavloom-${new Date().toISOString().slice(0,19).replace("T","-").replaceAll(":","")}\
.${e}`,cg=e=>/[",\n]/.test(e)?`"${e.replaceAll('"','""')}"`:e;function Ws({topic:e,formula:t,scale:n,offset:r}){let o=n===
1?"":` * ${n}`;return`${e} ${t}${o}${r===0?"":` + ${r}`}`}function fg(e){let t=new Map,n=Zt();e.forEach((o,l)=>{let[a,c]=ir(
o,n);for(let d=0;d<a.length;++d){let m=a[d],g=c[d];if(m<n.from||m>n.to||Number.isNaN(g))continue;let _=t.get(m)??e.map(()=>"");
_[l]=String(g*o.scale+o.offset),t.set(m,_)}});let r=[...t].sort(([o],[l])=>o-l).map(([o,l])=>[o.toFixed(6),...l].join(","));
return[["time_s",...e.map(o=>cg(Ws(o)))].join(","),...r,""].join(`
`)}var ff=e=>uf(cf("csv"),new Blob([fg(e)],{type:"text/csv"}));function pf(e,t){let n=devicePixelRatio||1,r=24*n,o=document.
createElement("canvas");o.width=e.width,o.height=e.height+r;let l=o.getContext("2d");if(!l)return;l.fillStyle=nr("panel"),
l.fillRect(0,0,o.width,o.height),l.drawImage(e,0,r),l.font=`${12*n}px system-ui, sans-serif`,l.textBaseline="middle";let a=12*
n;t.forEach((c,d)=>{l.fillStyle=nr(`series-${d%8}`),l.fillText(Ws(c),a,r/2),a+=l.measureText(Ws(c)).width+24*n}),o.toBlob(
c=>{c&&uf(cf("png"),c)})}var pg="uplot",dg="u-hz",mg="u-vt",hg="u-title",gg="u-wrap",vg="u-under",_g="u-over",bg="u-axis",ur="u-off",xg="u-select",
wg="u-cursor-x",yg="u-cursor-y",Sg="u-cursor-pt",kg="u-legend",Mg="u-live",Tg="u-inline",Ag="u-series",Eg="u-marker",df="\
u-label",Ng="u-value",Wo="width",Go="height";var mf="bottom",Zr="left",Gs="right",sa="#000",hf=sa+"0",Bs="mousemove",gf="mousedown",js="mouseup",vf="mouseenter",_f="\
mouseleave",bf="dblclick",Pg="resize",Og="scroll",xf="change",oi="dppxchange",aa="--",ro=typeof window<"u",Js=ro?document:
null,Xr=ro?window:null,Fg=ro?navigator:null,ce,ei;function Xs(){let e=devicePixelRatio;ce!=e&&(ce=e,ei&&ea(xf,ei,Xs),ei=
matchMedia(`(min-resolution: ${ce-.001}dppx) and (max-resolution: ${ce+.001}dppx)`),cr(xf,ei,Xs),Xr.dispatchEvent(new CustomEvent(
oi)))}function At(e,t){if(t!=null){let n=e.classList;!n.contains(t)&&n.add(t)}}function Qs(e,t){let n=e.classList;n.contains(
t)&&n.remove(t)}function Se(e,t,n){e.style[t]=n+"px"}function Jt(e,t,n,r){let o=Js.createElement(e);return t!=null&&At(o,
t),n?.insertBefore(o,r),o}function It(e,t){return Jt("div",e,t)}var wf=new WeakMap;function hn(e,t,n,r,o){let l="transla\
te("+t+"px,"+n+"px)",a=wf.get(e);l!=a&&(e.style.transform=l,wf.set(e,l),t<0||n<0||t>r||n>o?At(e,ur):Qs(e,ur))}var yf=new WeakMap;
function Sf(e,t,n){let r=t+n,o=yf.get(e);r!=o&&(yf.set(e,r),e.style.background=t,e.style.borderColor=n)}var kf=new WeakMap;
function Mf(e,t,n,r){let o=t+""+n,l=kf.get(e);o!=l&&(kf.set(e,o),e.style.height=n+"px",e.style.width=t+"px",e.style.marginLeft=
r?-t/2+"px":0,e.style.marginTop=r?-n/2+"px":0)}var ua={passive:!0},Cg={...ua,capture:!0};function cr(e,t,n,r){t.addEventListener(
e,n,r?Cg:ua)}function ea(e,t,n,r){t.removeEventListener(e,n,ua)}ro&&Xs();function Xt(e,t,n,r){let o;n=n||0,r=r||t.length-
1;let l=r<=2147483647;for(;r-n>1;)o=l?n+r>>1:Et((n+r)/2),t[o]<e?n=o:r=o;return e-t[n]<=t[r]-e?n:r}function Qf(e){return(n,r,o)=>{
let l=-1,a=-1;for(let c=r;c<=o;c++)if(e(n[c])){l=c;break}for(let c=o;c>=r;c--)if(e(n[c])){a=c;break}return[l,a]}}var ep=e=>e!=
null,tp=e=>e!=null&&e>0,si=Qf(ep),Dg=Qf(tp);function $g(e,t,n,r=0,o=!1){let l=o?Dg:si,a=o?tp:ep;[t,n]=l(e,t,n);let c=e[t],
d=e[t];if(t>-1)if(r==1)c=e[t],d=e[n];else if(r==-1)c=e[n],d=e[t];else for(let m=t;m<=n;m++){let g=e[m];a(g)&&(g<c?c=g:g>
d&&(d=g))}return[c??ve,d??-ve]}function ai(e,t,n,r){let o=Ef(e),l=Ef(t);e==t&&(o==-1?(e*=n,t/=n):(e/=n,t*=n));let a=n==10?
Sn:np,c=o==1?Et:Vt,d=l==1?Vt:Et,m=c(a(We(e))),g=d(a(We(t))),_=Qr(n,m),x=Qr(n,g);return n==10&&(m<0&&(_=_e(_,-m)),g<0&&(x=
_e(x,-g))),r||n==2?(e=_*o,t=x*l):(e=ip(e,_),t=ui(t,x)),[e,t]}function ca(e,t,n,r){let o=ai(e,t,n,r);return e==0&&(o[0]=0),
t==0&&(o[1]=0),o}var fa=.1,Tf={mode:3,pad:fa},jo={pad:0,soft:null,mode:0},Lg={min:jo,max:jo};function li(e,t,n,r){return ci(
n)?Af(e,t,n):(jo.pad=n,jo.soft=r?0:null,jo.mode=r?3:0,Af(e,t,Lg))}function se(e,t){return e??t}function Rg(e,t,n){for(t=
se(t,0),n=se(n,e.length-1);t<=n;){if(e[t]!=null)return!0;t++}return!1}function Af(e,t,n){let r=n.min,o=n.max,l=se(r.pad,
0),a=se(o.pad,0),c=se(r.hard,-ve),d=se(o.hard,ve),m=se(r.soft,ve),g=se(o.soft,-ve),_=se(r.mode,0),x=se(o.mode,0),v=t-e,k=Sn(
v),N=ct(We(e),We(t)),E=Sn(N),F=We(E-k);(v<1e-24||F>10)&&(v=0,(e==0||t==0)&&(v=1e-24,_==2&&m!=ve&&(l=0),x==2&&g!=-ve&&(a=
0)));let w=v||N||1e3,P=Sn(w),S=Qr(10,Et(P)),K=w*(v==0?e==0?.1:1:l),L=_e(ip(e-K,S/10),24),Z=e>=m&&(_==1||_==3&&L<=m||_==2&&
L>=m)?m:ve,G=ct(c,L<Z&&e>=Z?Z:Qt(Z,L)),X=w*(v==0?t==0?.1:1:a),W=_e(ui(t+X,S/10),24),A=t<=g&&(x==1||x==3&&W>=g||x==2&&W<=
g)?g:-ve,B=Qt(d,W>A&&t<=A?A:ct(A,W));return G==B&&G==0&&(B=100),[G,B]}var Ig=new Intl.NumberFormat(ro?Fg.language:"en-US"),
pa=e=>Ig.format(e),Nt=Math,ri=Nt.PI,We=Nt.abs,Et=Nt.floor,Ue=Nt.round,Vt=Nt.ceil,Qt=Nt.min,ct=Nt.max,Qr=Nt.pow,Ef=Nt.sign,
Sn=Nt.log10,np=Nt.log2,Vg=(e,t=1)=>Nt.sinh(e)*t,qs=(e,t=1)=>Nt.asinh(e/t),ve=1/0;function Nf(e){return(Sn((e^e>>31)-(e>>
31))|0)+1}function ta(e,t,n){return Qt(ct(e,t),n)}function rp(e){return typeof e=="function"}function te(e){return rp(e)?
e:()=>e}var zg=()=>{},op=e=>e,lp=(e,t)=>t,Hg=e=>null,Pf=e=>!0,Of=(e,t)=>e==t,Ug=/\.\d*?(?=9{6,}|0{6,})/gm,fr=e=>{if(ap(e)||
Ln.has(e))return e;let t=`${e}`,n=t.match(Ug);if(n==null)return e;let r=n[0].length-1;if(t.indexOf("e-")!=-1){let[o,l]=t.
split("e");return+`${fr(o)}e${l}`}return _e(e,r)};function sr(e,t){return fr(_e(fr(e/t))*t)}function ui(e,t){return fr(Vt(
fr(e/t))*t)}function ip(e,t){return fr(Et(fr(e/t))*t)}function _e(e,t=0){if(ap(e))return e;let n=10**t,r=e*n*(1+Number.EPSILON);
return Ue(r)/n}var Ln=new Map;function sp(e){return((""+e).split(".")[1]||"").length}function Yo(e,t,n,r){let o=[],l=r.map(
sp);for(let a=t;a<n;a++){let c=We(a),d=_e(Qr(e,a),c);for(let m=0;m<r.length;m++){let g=e==10?+`${r[m]}e${a}`:r[m]*d,_=(a>=
0?0:c)+(a>=l[m]?0:l[m]),x=e==10?g:_e(g,_);o.push(x),Ln.set(x,_)}}return o}var qo={},da=[],eo=[null,null],$n=Array.isArray,
ap=Number.isInteger,Wg=e=>e===void 0;function Ff(e){return typeof e=="string"}function ci(e){let t=!1;if(e!=null){let n=e.
constructor;t=n==null||n==Object}return t}function Gg(e){return e!=null&&typeof e=="object"}var Bg=Object.getPrototypeOf(
Uint8Array),up="__proto__";function to(e,t=ci){let n;if($n(e)){let r=e.find(o=>o!=null);if($n(r)||t(r)){n=Array(e.length);
for(let o=0;o<e.length;o++)n[o]=to(e[o],t)}else n=e.slice()}else if(e instanceof Bg)n=e.slice();else if(t(e)){n={};for(let r in e)
r!=up&&(n[r]=to(e[r],t))}else n=e;return n}function Le(e){let t=arguments;for(let n=1;n<t.length;n++){let r=t[n];for(let o in r)
o!=up&&(ci(e[o])?Le(e[o],to(r[o])):e[o]=to(r[o]))}return e}var jg=0,qg=1,Yg=2;function Kg(e,t,n){for(let r=0,o,l=-1;r<t.
length;r++){let a=t[r];if(a>l){for(o=a-1;o>=0&&e[o]==null;)e[o--]=null;for(o=a+1;o<n&&e[o]==null;)e[l=o++]=null}}}function Zg(e,t){
if(Qg(e)){let a=e[0].slice();for(let c=1;c<e.length;c++)a.push(...e[c].slice(1));return ev(a[0])||(a=Xg(a)),a}let n=new Set;
for(let a=0;a<e.length;a++){let d=e[a][0],m=d.length;for(let g=0;g<m;g++)n.add(d[g])}let r=[Array.from(n).sort((a,c)=>a-
c)],o=r[0].length,l=new Map;for(let a=0;a<o;a++)l.set(r[0][a],a);for(let a=0;a<e.length;a++){let c=e[a],d=c[0];for(let m=1;m<
c.length;m++){let g=c[m],_=Array(o).fill(void 0),x=t?t[a][m]:qg,v=[];for(let k=0;k<g.length;k++){let N=g[k],E=l.get(d[k]);
N===null?x!=jg&&(_[E]=N,x==Yg&&v.push(E)):_[E]=N}Kg(_,v,o),r.push(_)}}return r}var Jg=typeof queueMicrotask>"u"?e=>Promise.
resolve().then(e):queueMicrotask;function Xg(e){let t=e[0],n=t.length,r=Array(n);for(let l=0;l<r.length;l++)r[l]=l;r.sort(
(l,a)=>t[l]-t[a]);let o=[];for(let l=0;l<e.length;l++){let a=e[l],c=Array(n);for(let d=0;d<n;d++)c[d]=a[r[d]];o.push(c)}
return o}function Qg(e){let t=e[0][0],n=t.length;for(let r=1;r<e.length;r++){let o=e[r][0];if(o.length!=n)return!1;if(o!=
t){for(let l=0;l<n;l++)if(o[l]!=t[l])return!1}}return!0}function ev(e,t=100){let n=e.length;if(n<=1)return!0;let r=0,o=n-
1;for(;r<=o&&e[r]==null;)r++;for(;o>=r&&e[o]==null;)o--;if(o<=r)return!0;let l=ct(1,Et((o-r+1)/t));for(let a=e[r],c=r+l;c<=
o;c+=l){let d=e[c];if(d!=null){if(d<=a)return!1;a=d}}return!0}var cp=["January","February","March","April","May","June",
"July","August","September","October","November","December"],fp=["Sunday","Monday","Tuesday","Wednesday","Thursday","Fri\
day","Saturday"];function pp(e){return e.slice(0,3)}var tv=fp.map(pp),nv=cp.map(pp),rv={MMMM:cp,MMM:nv,WWWW:fp,WWW:tv};function Uo(e){
return(e<10?"0":"")+e}function ov(e){return(e<10?"00":e<100?"0":"")+e}var lv={YYYY:e=>e.getFullYear(),YY:e=>(e.getFullYear()+
"").slice(2),MMMM:(e,t)=>t.MMMM[e.getMonth()],MMM:(e,t)=>t.MMM[e.getMonth()],MM:e=>Uo(e.getMonth()+1),M:e=>e.getMonth()+
1,DD:e=>Uo(e.getDate()),D:e=>e.getDate(),WWWW:(e,t)=>t.WWWW[e.getDay()],WWW:(e,t)=>t.WWW[e.getDay()],HH:e=>Uo(e.getHours()),
H:e=>e.getHours(),h:e=>{let t=e.getHours();return t==0?12:t>12?t-12:t},AA:e=>e.getHours()>=12?"PM":"AM",aa:e=>e.getHours()>=
12?"pm":"am",a:e=>e.getHours()>=12?"p":"a",mm:e=>Uo(e.getMinutes()),m:e=>e.getMinutes(),ss:e=>Uo(e.getSeconds()),s:e=>e.
getSeconds(),fff:e=>ov(e.getMilliseconds())};function ma(e,t){t=t||rv;let n=[],r=/\{([a-z]+)\}|[^{]+/gi,o;for(;o=r.exec(
e);)n.push(o[0][0]=="{"?lv[o[1]]:o[0]);return l=>{let a="";for(let c=0;c<n.length;c++)a+=typeof n[c]=="string"?n[c]:n[c](
l,t);return a}}var iv=new Intl.DateTimeFormat().resolvedOptions().timeZone;function sv(e,t){let n;return t=="UTC"||t=="E\
tc/UTC"?n=new Date(+e+e.getTimezoneOffset()*6e4):t==iv?n=e:(n=new Date(e.toLocaleString("en-US",{timeZone:t})),n.setMilliseconds(
e.getMilliseconds())),n}var dp=e=>e%1==0,ii=[1,2,2.5,5],av=Yo(10,-32,0,ii),mp=Yo(10,0,32,ii),uv=mp.filter(dp),ar=av.concat(
mp),ha=`
`,hp="{YYYY}",Cf=ha+hp,gp="{M}/{D}",Bo=ha+gp,ti=Bo+"/{YY}",vp="{aa}",cv="{h}:{mm}",Jr=cv+vp,Df=ha+Jr,$f=":{ss}",de=null;
function _p(e){let t=e*1e3,n=t*60,r=n*60,o=r*24,l=o*30,a=o*365,d=(e==1?Yo(10,0,3,ii).filter(dp):Yo(10,-3,0,ii)).concat([
t,t*5,t*10,t*15,t*30,n,n*5,n*10,n*15,n*30,r,r*2,r*3,r*4,r*6,r*8,r*12,o,o*2,o*3,o*4,o*5,o*6,o*7,o*8,o*9,o*10,o*15,l,l*2,l*
3,l*4,l*6,a,a*2,a*5,a*10,a*25,a*50,a*100]),m=[[a,hp,de,de,de,de,de,de,1],[o*28,"{MMM}",Cf,de,de,de,de,de,1],[o,gp,Cf,de,
de,de,de,de,1],[r,"{h}"+vp,ti,de,Bo,de,de,de,1],[n,Jr,ti,de,Bo,de,de,de,1],[t,$f,ti+" "+Jr,de,Bo+" "+Jr,de,Df,de,1],[e,$f+
".{fff}",ti+" "+Jr,de,Bo+" "+Jr,de,Df,de,1]];function g(_){return(x,v,k,N,E,F)=>{let w=[],P=E>=a,S=E>=l&&E<a,K=_(k),L=_e(
K*e,3),Z=Ys(K.getFullYear(),P?0:K.getMonth(),S||P?1:K.getDate()),G=_e(Z*e,3);if(S||P){let X=S?E/l:0,W=P?E/a:0,A=L==G?L:_e(
Ys(Z.getFullYear()+W,Z.getMonth()+X,1)*e,3),B=new Date(Ue(A/e)),C=B.getFullYear(),q=B.getMonth();for(let U=0;A<=N;U++){let ne=Ys(
C+W*U,q+X*U,1),H=ne-_(_e(ne*e,3));A=_e((+ne+H)*e,3),A<=N&&w.push(A)}}else{let X=E>=o?o:E,W=Et(k)-Et(L),A=G+W+ui(L-G,X);w.
push(A);let B=_(A),C=B.getHours()+B.getMinutes()/n+B.getSeconds()/r,q=E/r,U=x.axes[v]._space,ne=F/U;for(;A=_e(A+E,e==1?0:
3),!(A>N);)if(q>1){let H=Et(_e(C+q,6))%24,le=_(A).getHours()-H;le>1&&(le=-1),A-=le*r,C=(C+q)%24;let me=w[w.length-1];_e(
(A-me)/E,3)*ne>=.7&&w.push(A)}else w.push(A)}return w}}return[d,m,g]}var[fv,pv,dv]=_p(1),[mv,hv,gv]=_p(.001);Yo(2,-53,53,
[1]);function Lf(e,t){return e.map(n=>n.map((r,o)=>o==0||o==8||r==null?r:t(o==1||n[8]==0?r:n[1]+r)))}function Rf(e,t){return(n,r,o,l,a)=>{
let c=t.find(k=>a>=k[0])||t[t.length-1],d,m,g,_,x,v;return r.map(k=>{let N=e(k),E=N.getFullYear(),F=N.getMonth(),w=N.getDate(),
P=N.getHours(),S=N.getMinutes(),K=N.getSeconds(),L=E!=d&&c[2]||F!=m&&c[3]||w!=g&&c[4]||P!=_&&c[5]||S!=x&&c[6]||K!=v&&c[7]||
c[1];return d=E,m=F,g=w,_=P,x=S,v=K,L(N)})}}function vv(e,t){let n=ma(t);return(r,o,l,a,c)=>o.map(d=>n(e(d)))}function Ys(e,t,n){
return new Date(e,t,n)}function If(e,t){return t(e)}var _v="{YYYY}-{MM}-{DD} {h}:{mm}{aa}";function Vf(e,t){return(n,r,o,l)=>l==
null?aa:t(e(r))}function bv(e,t){let n=e.series[t];return n.width?n.stroke(e,t):n.points.width?n.points.stroke(e,t):null}
function xv(e,t){return e.series[t].fill(e,t)}var wv={show:!0,live:!0,isolate:!1,mount:zg,markers:{show:!0,width:2,stroke:bv,
fill:xv,dash:"solid"},idx:null,idxs:null,values:[]};function yv(e,t){let n=e.cursor.points,r=It(),o=n.size(e,t);Se(r,Wo,
o),Se(r,Go,o);let l=o/-2;Se(r,"marginLeft",l),Se(r,"marginTop",l);let a=n.width(e,t,o);return a&&Se(r,"borderWidth",a),r}
function Sv(e,t){let n=e.series[t].points;return n._fill||n._stroke}function kv(e,t){let n=e.series[t].points;return n._stroke||
n._fill}function Mv(e,t){return e.series[t].points.size}var Ks=[0,0];function Tv(e,t,n){return Ks[0]=t,Ks[1]=n,Ks}function ni(e,t,n,r=!0){
return o=>{o.button==0&&(!r||o.target==t)&&n(o)}}function Zs(e,t,n,r=!0){return o=>{(!r||o.target==t)&&n(o)}}var Av={show:!0,
x:!0,y:!0,lock:!1,move:Tv,points:{one:!1,show:yv,size:Mv,width:0,stroke:kv,fill:Sv},bind:{mousedown:ni,mouseup:ni,click:ni,
dblclick:ni,mousemove:Zs,mouseleave:Zs,mouseenter:Zs},drag:{setScale:!0,x:!0,y:!1,dist:0,uni:null,click:(e,t)=>{t.stopPropagation(),
t.stopImmediatePropagation()},_x:!1,_y:!1},focus:{dist:(e,t,n,r,o)=>r-o,prox:-1,bias:0},hover:{skip:[void 0],prox:null,bias:0},
left:-10,top:-10,idx:null,dataIdx:null,idxs:null,event:null},bp={show:!0,stroke:"rgba(0,0,0,0.07)",width:2},ga=Le({},bp,
{filter:lp}),xp=Le({},ga,{size:10}),wp=Le({},bp,{show:!1}),va='12px system-ui, -apple-system, "Segoe UI", Roboto, "Helve\
tica Neue", Arial, "Noto Sans", sans-serif, "Apple Color Emoji", "Segoe UI Emoji", "Segoe UI Symbol", "Noto Color Emoji"',
yp="bold "+va,Sp=1.5,zf={show:!0,scale:"x",stroke:sa,space:50,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:yp,
side:2,grid:ga,ticks:xp,border:wp,font:va,lineGap:Sp,rotate:0},Ev="Value",Nv="Time",Hf={show:!0,scale:"x",auto:!1,sorted:1,
min:ve,max:-ve,idxs:[]};function Pv(e,t,n,r,o){return t.map(l=>l==null?"":pa(l))}function Ov(e,t,n,r,o,l,a){let c=[],d=Ln.
get(o)||0;n=a?n:_e(ui(n,o),d);for(let m=n;m<=r;m=_e(m+o,d))c.push(Object.is(m,-0)?0:m);return c}function na(e,t,n,r,o,l,a){
let c=[],d=e.scales[e.axes[t].scale].log,m=d==10?Sn:np,g=Et(m(n));o=Qr(d,g),d==10&&(o=ar[Xt(o,ar)]);let _=n,x=o*d;d==10&&
(x=ar[Xt(x,ar)]);do c.push(_),_=_+o,d==10&&!Ln.has(_)&&(_=_e(_,Ln.get(o))),_>=x&&(o=_,x=o*d,d==10&&(x=ar[Xt(x,ar)]));while(_<=
r);return c}function Fv(e,t,n,r,o,l,a){let d=e.scales[e.axes[t].scale].asinh,m=r>d?na(e,t,ct(d,n),r,o):[d],g=r>=0&&n<=0?
[0]:[];return(n<-d?na(e,t,ct(d,-r),-n,o):[d]).reverse().map(x=>-x).concat(g,m)}var kp=/./,Cv=/[12357]/,Dv=/[125]/,Uf=/1/,
ra=(e,t,n,r)=>e.map((o,l)=>t==4&&o==0||l%r==0&&n.test(o.toExponential()[o<0?1:0])?o:null);function $v(e,t,n,r,o){let l=e.
axes[n],a=l.scale,c=e.scales[a],d=e.valToPos,m=l._space,g=d(10,a),_=d(9,a)-g>=m?kp:d(7,a)-g>=m?Cv:d(5,a)-g>=m?Dv:Uf;if(_==
Uf){let x=We(d(1,a)-g);if(x<m)return ra(t.slice().reverse(),c.distr,_,Vt(m/x)).reverse()}return ra(t,c.distr,_,1)}function Lv(e,t,n,r,o){
let l=e.axes[n],a=l.scale,c=l._space,d=e.valToPos,m=We(d(1,a)-d(2,a));return m<c?ra(t.slice().reverse(),3,kp,Vt(c/m)).reverse():
t}function Rv(e,t,n,r){return r==null?aa:t==null?"":pa(t)}var Wf={show:!0,scale:"y",stroke:sa,space:30,gap:5,alignTo:1,size:50,
labelGap:0,labelSize:30,labelFont:yp,side:3,grid:ga,ticks:xp,border:wp,font:va,lineGap:Sp,rotate:0};function Iv(e,t){let n=3+
(e||1)*2;return _e(n*t,3)}function Vv(e,t){let{scale:n,idxs:r}=e.series[0],o=e._data[0],l=e.valToPos(o[r[0]],n,!0),a=e.valToPos(
o[r[1]],n,!0),c=We(a-l),d=e.series[t],m=c/(d.points.space*ce);return r[1]-r[0]<=m}var Gf={scale:null,auto:!0,sorted:0,min:ve,
max:-ve},Mp=(e,t,n,r,o)=>o,Bf={show:!0,auto:!0,sorted:0,gaps:Mp,alpha:1,facets:[Le({},Gf,{scale:"x"}),Le({},Gf,{scale:"y"})]},
jf={scale:"y",auto:!0,sorted:0,show:!0,spanGaps:!1,gaps:Mp,alpha:1,points:{show:Vv,filter:null},values:null,min:ve,max:-ve,
idxs:[],path:null,clip:null};function zv(e,t,n,r,o){return n/10}var Tp={time:!0,auto:!0,distr:1,log:10,asinh:1,min:null,
max:null,dir:1,ori:0},Hv=Le({},Tp,{time:!1,ori:1}),qf={};function Ap(e,t){let n=qf[e];return n||(n={key:e,plots:[],sub(r){
n.plots.push(r)},unsub(r){n.plots=n.plots.filter(o=>o!=r)},pub(r,o,l,a,c,d,m){for(let g=0;g<n.plots.length;g++)n.plots[g]!=
o&&n.plots[g].pub(r,o,l,a,c,d,m)}},e!=null&&(qf[e]=n)),n}var no=1,oa=2;function pr(e,t,n){let r=e.mode,o=e.series[t],l=r==
2?e._data[t]:e._data,a=e.scales,c=e.bbox,d=l[0],m=r==2?l[1]:l[t],g=r==2?a[o.facets[0].scale]:a[e.series[0].scale],_=r==2?
a[o.facets[1].scale]:a[o.scale],x=c.left,v=c.top,k=c.width,N=c.height,E=e.valToPosH,F=e.valToPosV;return g.ori==0?n(o,d,
m,g,_,E,F,x,v,k,N,pi,oo,mi,Np,Op):n(o,d,m,g,_,F,E,v,x,N,k,di,lo,xa,Pp,Fp)}function _a(e,t){let n=0,r=0,o=se(e.bands,da);
for(let l=0;l<o.length;l++){let a=o[l];a.series[0]==t?n=a.dir:a.series[1]==t&&(a.dir==1?r|=1:r|=2)}return[n,r==1?-1:r==2?
1:r==3?2:0]}function Uv(e,t,n,r,o){let l=e.mode,a=e.series[t],c=l==2?a.facets[1].scale:a.scale,d=e.scales[c];return o==-1?
d.min:o==1?d.max:d.distr==3?d.dir==1?d.min:d.max:0}function kn(e,t,n,r,o,l){return pr(e,t,(a,c,d,m,g,_,x,v,k,N,E)=>{let F=a.
pxRound,w=m.dir*(m.ori==0?1:-1),P=m.ori==0?oo:lo,S,K;w==1?(S=n,K=r):(S=r,K=n);let L=F(_(c[S],m,N,v)),Z=F(x(d[S],g,E,k)),
G=F(_(c[K],m,N,v)),X=F(x(l==1?g.max:g.min,g,E,k)),W=new Path2D(o);return P(W,G,X),P(W,L,X),P(W,L,Z),W})}function fi(e,t,n,r,o,l){
let a=null;if(e.length>0){a=new Path2D;let c=t==0?mi:xa,d=n;for(let _=0;_<e.length;_++){let x=e[_];if(x[1]>x[0]){let v=x[0]-
d;v>0&&c(a,d,r,v,r+l),d=x[1]}}let m=n+o-d,g=10;m>0&&c(a,d,r-g/2,m,r+l+g)}return a}function Wv(e,t,n){let r=e[e.length-1];
r&&r[0]==t?r[1]=n:e.push([t,n])}function ba(e,t,n,r,o,l,a){let c=[],d=e.length;for(let m=o==1?n:r;m>=n&&m<=r;m+=o)if(t[m]===
null){let _=m,x=m;if(o==1)for(;++m<=r&&t[m]===null;)x=m;else for(;--m>=n&&t[m]===null;)x=m;let v=l(e[_]),k=x==_?v:l(e[x]),
N=_-o;v=a<=0&&N>=0&&N<d?l(e[N]):v;let F=x+o;k=a>=0&&F>=0&&F<d?l(e[F]):k,k>=v&&c.push([v,k])}return c}function Yf(e){return e==
0?op:e==1?Ue:t=>sr(t,e)}function Ep(e){let t=e==0?pi:di,n=e==0?(o,l,a,c,d,m)=>{o.arcTo(l,a,c,d,m)}:(o,l,a,c,d,m)=>{o.arcTo(
a,l,d,c,m)},r=e==0?(o,l,a,c,d)=>{o.rect(l,a,c,d)}:(o,l,a,c,d)=>{o.rect(a,l,d,c)};return(o,l,a,c,d,m=0,g=0)=>{m==0&&g==0?
r(o,l,a,c,d):(m=Qt(m,c/2,d/2),g=Qt(g,c/2,d/2),t(o,l+m,a),n(o,l+c,a,l+c,a+d,m),n(o,l+c,a+d,l,a+d,g),n(o,l,a+d,l,a,g),n(o,
l,a,l+c,a,m),o.closePath())}}var pi=(e,t,n)=>{e.moveTo(t,n)},di=(e,t,n)=>{e.moveTo(n,t)},oo=(e,t,n)=>{e.lineTo(t,n)},lo=(e,t,n)=>{
e.lineTo(n,t)},mi=Ep(0),xa=Ep(1),Np=(e,t,n,r,o,l)=>{e.arc(t,n,r,o,l)},Pp=(e,t,n,r,o,l)=>{e.arc(n,t,r,o,l)},Op=(e,t,n,r,o,l,a)=>{
e.bezierCurveTo(t,n,r,o,l,a)},Fp=(e,t,n,r,o,l,a)=>{e.bezierCurveTo(n,t,o,r,a,l)};function Cp(e){return(t,n,r,o,l)=>pr(t,
n,(a,c,d,m,g,_,x,v,k,N,E)=>{let{pxRound:F,points:w}=a,P,S;m.ori==0?(P=pi,S=Np):(P=di,S=Pp);let K=_e(w.width*ce,3),L=(w.size-
w.width)/2*ce,Z=_e(L*2,3),G=new Path2D,X=new Path2D,{left:W,top:A,width:B,height:C}=t.bbox;mi(X,W-Z,A-Z,B+Z*2,C+Z*2);let q=U=>{
if(d[U]!=null){let ne=F(_(c[U],m,N,v)),H=F(x(d[U],g,E,k));P(G,ne+L,H),S(G,ne,H,L,0,ri*2)}};if(l)l.forEach(q);else for(let U=r;U<=
o;U++)q(U);return{stroke:K>0?G:null,fill:G,clip:X,flags:no|oa}})}function Dp(e){return(t,n,r,o,l,a)=>{r!=o&&(l!=r&&a!=r&&
e(t,n,r),l!=o&&a!=o&&e(t,n,o),e(t,n,a))}}var Gv=Dp(oo),Bv=Dp(lo);function $p(e){let t=se(e?.alignGaps,0);return(n,r,o,l)=>pr(
n,r,(a,c,d,m,g,_,x,v,k,N,E)=>{[o,l]=si(d,o,l);let F=a.pxRound,w=C=>F(_(C,m,N,v)),P=C=>F(x(C,g,E,k)),S,K;m.ori==0?(S=oo,K=
Gv):(S=lo,K=Bv);let L=m.dir*(m.ori==0?1:-1),Z={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:no},G=Z.stroke,
X=!1;if(l-o>=N*4){let C=V=>n.posToVal(V,m.key,!0),q=null,U=null,ne,H,ft,ke=w(c[L==1?o:l]),le=w(c[o]),me=w(c[l]),Q=C(L==1?
le+1:me-1);for(let V=L==1?o:l;V>=o&&V<=l;V+=L){let Re=c[V],Me=(L==1?Re<Q:Re>Q)?ke:w(Re),fe=d[V];Me==ke?fe!=null?(H=fe,q==
null?(S(G,Me,P(H)),ne=q=U=H):H<q?q=H:H>U&&(U=H)):fe===null&&(X=!0):(q!=null&&K(G,ke,P(q),P(U),P(ne),P(H)),fe!=null?(H=fe,
S(G,Me,P(H)),q=U=ne=H):(q=U=null,fe===null&&(X=!0)),ke=Me,Q=C(ke+L))}q!=null&&q!=U&&ft!=ke&&K(G,ke,P(q),P(U),P(ne),P(H))}else
for(let C=L==1?o:l;C>=o&&C<=l;C+=L){let q=d[C];q===null?X=!0:q!=null&&S(G,w(c[C]),P(q))}let[A,B]=_a(n,r);if(a.fill!=null||
A!=0){let C=Z.fill=new Path2D(G),q=a.fillTo(n,r,a.min,a.max,A),U=P(q),ne=w(c[o]),H=w(c[l]);L==-1&&([H,ne]=[ne,H]),S(C,H,
U),S(C,ne,U)}if(!a.spanGaps){let C=[];X&&C.push(...ba(c,d,o,l,L,w,t)),Z.gaps=C=a.gaps(n,r,o,l,C),Z.clip=fi(C,m.ori,v,k,N,
E)}return B!=0&&(Z.band=B==2?[kn(n,r,o,l,G,-1),kn(n,r,o,l,G,1)]:kn(n,r,o,l,G,B)),Z})}function jv(e){let t=se(e.align,1),
n=se(e.ascDesc,!1),r=se(e.alignGaps,0),o=se(e.extend,!1);return(l,a,c,d)=>pr(l,a,(m,g,_,x,v,k,N,E,F,w,P)=>{[c,d]=si(_,c,
d);let S=m.pxRound,{left:K,width:L}=l.bbox,Z=le=>S(k(le,x,w,E)),G=le=>S(N(le,v,P,F)),X=x.ori==0?oo:lo,W={stroke:new Path2D,
fill:null,clip:null,band:null,gaps:null,flags:no},A=W.stroke,B=x.dir*(x.ori==0?1:-1),C=G(_[B==1?c:d]),q=Z(g[B==1?c:d]),U=q,
ne=q;o&&t==-1&&(ne=K,X(A,ne,C)),X(A,q,C);for(let le=B==1?c:d;le>=c&&le<=d;le+=B){let me=_[le];if(me==null)continue;let Q=Z(
g[le]),V=G(me);t==1?X(A,Q,C):X(A,U,V),X(A,Q,V),C=V,U=Q}let H=U;o&&t==1&&(H=K+L,X(A,H,C));let[ft,ke]=_a(l,a);if(m.fill!=null||
ft!=0){let le=W.fill=new Path2D(A),me=m.fillTo(l,a,m.min,m.max,ft),Q=G(me);X(le,H,Q),X(le,ne,Q)}if(!m.spanGaps){let le=[];
le.push(...ba(g,_,c,d,B,Z,r));let me=m.width*ce/2,Q=n||t==1?me:-me,V=n||t==-1?-me:me;le.forEach(Re=>{Re[0]+=Q,Re[1]+=V}),
W.gaps=le=m.gaps(l,a,c,d,le),W.clip=fi(le,x.ori,E,F,w,P)}return ke!=0&&(W.band=ke==2?[kn(l,a,c,d,A,-1),kn(l,a,c,d,A,1)]:
kn(l,a,c,d,A,ke)),W})}function Kf(e,t,n,r,o,l,a=ve){if(e.length>1){let c=null;for(let d=0,m=1/0;d<e.length;d++)if(t[d]!==
void 0){if(c!=null){let g=We(e[d]-e[c]);g<m&&(m=g,a=We(n(e[d],r,o,l)-n(e[c],r,o,l)))}c=d}}return a}function qv(e){e=e||qo;
let t=se(e.size,[.6,ve,1]),n=e.align||0,r=e.gap||0,o=e.radius;o=o==null?[0,0]:typeof o=="number"?[o,0]:o;let l=te(o),a=1-
t[0],c=se(t[1],ve),d=se(t[2],1),m=se(e.disp,qo),g=se(e.each,v=>{}),{fill:_,stroke:x}=m;return(v,k,N,E)=>pr(v,k,(F,w,P,S,K,L,Z,G,X,W,A)=>{
let B=F.pxRound,C=n,q=r*ce,U=c*ce,ne=d*ce,H,ft;S.ori==0?[H,ft]=l(v,k):[ft,H]=l(v,k);let ke=S.dir*(S.ori==0?1:-1),le=S.ori==
0?mi:xa,me=S.ori==0?g:($,be,Ie,gr,Vn,tn,zn)=>{g($,be,Ie,Vn,gr,zn,tn)},Q=se(v.bands,da).find($=>$.series[0]==k),V=Q!=null?
Q.dir:0,Re=F.fillTo(v,k,F.min,F.max,V),nt=B(Z(Re,K,A,X)),Me,fe,Ht,_t=W,Ne=B(F.width*ce),en=!1,gn=null,Pt=null,Tn=null,dr=null;
_!=null&&(Ne==0||x!=null)&&(en=!0,gn=_.values(v,k,N,E),Pt=new Map,new Set(gn).forEach($=>{$!=null&&Pt.set($,new Path2D)}),
Ne>0&&(Tn=x.values(v,k,N,E),dr=new Map,new Set(Tn).forEach($=>{$!=null&&dr.set($,new Path2D)})));let{x0:mr,size:so}=m;if(mr!=
null&&so!=null){C=1,w=mr.values(v,k,N,E),mr.unit==2&&(w=w.map(Ie=>v.posToVal(G+Ie*W,S.key,!0)));let $=so.values(v,k,N,E);
so.unit==2?fe=$[0]*W:fe=L($[0],S,W,G)-L(0,S,W,G),_t=Kf(w,P,L,S,W,G,_t),Ht=_t-fe+q}else _t=Kf(w,P,L,S,W,G,_t),Ht=_t*a+q,fe=
_t-Ht;Ht<1&&(Ht=0),Ne>=fe/2&&(Ne=0),Ht<5&&(B=op);let Zo=Ht>0,Rn=_t-Ht-(Zo?Ne:0);fe=B(ta(Rn,ne,U)),Me=(C==0?fe/2:C==ke?0:
fe)-C*ke*((C==0?q/2:0)+(Zo?Ne/2:0));let rt={stroke:null,fill:null,clip:null,band:null,gaps:null,flags:0},hr=en?null:new Path2D,
vn=null;if(Q!=null)vn=v.data[Q.series[1]];else{let{y0:$,y1:be}=m;$!=null&&be!=null&&(P=be.values(v,k,N,E),vn=$.values(v,
k,N,E))}let In=H*fe,J=ft*fe;for(let $=ke==1?N:E;$>=N&&$<=E;$+=ke){let be=P[$];if(be==null)continue;if(vn!=null){let pt=vn[$]??
0;if(be-pt==0)continue;nt=Z(pt,K,A,X)}let Ie=S.distr!=2||m!=null?w[$]:$,gr=L(Ie,S,W,G),Vn=Z(se(be,Re),K,A,X),tn=B(gr-Me),
zn=B(ct(Vn,nt)),bt=B(Qt(Vn,nt)),Ot=zn-bt;if(be!=null){let pt=be<0?J:In,Ut=be<0?In:J;en?(Ne>0&&Tn[$]!=null&&le(dr.get(Tn[$]),
tn,bt+Et(Ne/2),fe,ct(0,Ot-Ne),pt,Ut),gn[$]!=null&&le(Pt.get(gn[$]),tn,bt+Et(Ne/2),fe,ct(0,Ot-Ne),pt,Ut)):le(hr,tn,bt+Et(
Ne/2),fe,ct(0,Ot-Ne),pt,Ut),me(v,k,$,tn-Ne/2,bt,fe+Ne,Ot)}}return Ne>0?rt.stroke=en?dr:hr:en||(rt._fill=F.width==0?F._fill:
F._stroke??F._fill,rt.width=0),rt.fill=en?Pt:hr,rt})}function Yv(e,t){let n=se(t?.alignGaps,0);return(r,o,l,a)=>pr(r,o,(c,d,m,g,_,x,v,k,N,E,F)=>{
[l,a]=si(m,l,a);let w=c.pxRound,P=H=>w(x(H,g,E,k)),S=H=>w(v(H,_,F,N)),K,L,Z;g.ori==0?(K=pi,Z=oo,L=Op):(K=di,Z=lo,L=Fp);let G=g.
dir*(g.ori==0?1:-1),X=P(d[G==1?l:a]),W=X,A=[],B=[];for(let H=G==1?l:a;H>=l&&H<=a;H+=G)if(m[H]!=null){let ke=d[H],le=P(ke);
A.push(W=le),B.push(S(m[H]))}let C={stroke:e(A,B,K,Z,L,w),fill:null,clip:null,band:null,gaps:null,flags:no},q=C.stroke,[
U,ne]=_a(r,o);if(c.fill!=null||U!=0){let H=C.fill=new Path2D(q),ft=c.fillTo(r,o,c.min,c.max,U),ke=S(ft);Z(H,W,ke),Z(H,X,
ke)}if(!c.spanGaps){let H=[];H.push(...ba(d,m,l,a,G,P,n)),C.gaps=H=c.gaps(r,o,l,a,H),C.clip=fi(H,g.ori,k,N,E,F)}return ne!=
0&&(C.band=ne==2?[kn(r,o,l,a,q,-1),kn(r,o,l,a,q,1)]:kn(r,o,l,a,q,ne)),C})}function Kv(e){return Yv(Zv,e)}function Zv(e,t,n,r,o,l){
let a=e.length;if(a<2)return null;let c=new Path2D;if(n(c,e[0],t[0]),a==2)r(c,e[1],t[1]);else{let d=Array(a),m=Array(a-1),
g=Array(a-1),_=Array(a-1);for(let x=0;x<a-1;x++)g[x]=t[x+1]-t[x],_[x]=e[x+1]-e[x],m[x]=g[x]/_[x];d[0]=m[0];for(let x=1;x<
a-1;x++)m[x]===0||m[x-1]===0||m[x-1]>0!=m[x]>0?d[x]=0:(d[x]=3*(_[x-1]+_[x])/((2*_[x]+_[x-1])/m[x-1]+(_[x]+2*_[x-1])/m[x]),
isFinite(d[x])||(d[x]=0));d[a-1]=m[a-2];for(let x=0;x<a-1;x++)o(c,e[x]+_[x]/3,t[x]+d[x]*_[x]/3,e[x+1]-_[x]/3,t[x+1]-d[x+
1]*_[x]/3,e[x+1],t[x+1])}return c}var la=new Set;function Zf(){for(let e of la)e.syncRect(!0)}ro&&(cr(Pg,Xr,Zf),cr(Og,Xr,
Zf,!0),cr(oi,Xr,()=>{Ze.pxRatio=ce}));var Jv=$p(),Xv=Cp();function Jf(e,t,n,r){return(r?[e[0],e[1]].concat(e.slice(2)):[
e[0]].concat(e.slice(1))).map((l,a)=>ia(l,a,t,n))}function Qv(e,t){return e.map((n,r)=>r==0?{}:Le({},t,n))}function ia(e,t,n,r){
return Le({},t==0?n:r,e)}function Lp(e,t,n){return t==null?eo:[t,n]}var e0=Lp;function t0(e,t,n){return t==null?eo:li(t,
n,fa,!0)}function Rp(e,t,n,r){return t==null?eo:ai(t,n,e.scales[r].log,!1)}var n0=Rp;function Ip(e,t,n,r){return t==null?
eo:ca(t,n,e.scales[r].log,!1)}var r0=Ip;function o0(e,t,n,r,o){let l=ct(Nf(e),Nf(t)),a=t-e,c=Xt(o/r*a,n);do{let d=n[c],m=r*
d/a;if(m>=o&&l+(d<5?Ln.get(d):0)<=17)return[d,m]}while(++c<n.length);return[0,0]}function Xf(e){let t,n;return e=e.replace(
/(\d+)px/,(r,o)=>(t=Ue((n=+o)*ce))+"px"),[e,t,n]}function l0(e){e.show&&[e.font,e.labelFont].forEach(t=>{let n=_e(t[2]*ce,
1);t[0]=t[0].replace(/[0-9.]+px/,n+"px"),t[1]=n})}function Ze(e,t,n){let r={mode:se(e.mode,1)},o=r.mode;function l(i,u,f,p){
let h=u.valToPct(i);return p+f*(u.dir==-1?1-h:h)}function a(i,u,f,p){let h=u.valToPct(i);return p+f*(u.dir==-1?h:1-h)}function c(i,u,f,p){
return u.ori==0?l(i,u,f,p):a(i,u,f,p)}r.valToPosH=l,r.valToPosV=a;let d=!1;r.status=0;let m=r.root=It(pg);if(e.id!=null&&
(m.id=e.id),At(m,e.class),e.title){let i=It(hg,m);i.textContent=e.title}let g=Jt("canvas"),_=r.ctx=g.getContext("2d"),x=It(
gg,m);cr("click",x,i=>{i.target===k&&(xe!=Ar||Te!=Er)&&Xe.click(r,i)},!0);let v=r.under=It(vg,x);x.appendChild(g);let k=r.
over=It(_g,x);e=to(e);let N=+se(e.pxAlign,1),E=Yf(N);(e.plugins||[]).forEach(i=>{i.opts&&(e=i.opts(r,e)||e)});let F=e.ms||
.001,w=r.series=o==1?Jf(e.series||[],Hf,jf,!1):Qv(e.series||[null],Bf),P=r.axes=Jf(e.axes||[],zf,Wf,!0),S=r.scales={},K=r.
bands=e.bands||[];K.forEach(i=>{i.fill=te(i.fill||null),i.dir=se(i.dir,-1)});let L=o==2?w[1].facets[0].scale:w[0].scale,
Z={axes:vd,series:pd},G=(e.drawOrder||["axes","series"]).map(i=>Z[i]);function X(i){let u=i.distr==3?f=>Sn(f>0?f:i.clamp(
r,f,i.min,i.max,i.key)):i.distr==4?f=>qs(f,i.asinh):i.distr==100?f=>i.fwd(f):f=>f;return f=>{let p=u(f),{_min:h,_max:b}=i,
y=b-h;return(p-h)/y}}function W(i){let u=S[i];if(u==null){let f=(e.scales||qo)[i]||qo;if(f.from!=null){W(f.from);let p=Le(
{},S[f.from],f,{key:i});p.valToPct=X(p),S[i]=p}else{u=S[i]=Le({},i==L?Tp:Hv,f),u.key=i;let p=u.time,h=u.range,b=$n(h);if((i!=
L||o==2&&!p)&&(b&&(h[0]==null||h[1]==null)&&(h={min:h[0]==null?Tf:{mode:1,hard:h[0],soft:h[0]},max:h[1]==null?Tf:{mode:1,
hard:h[1],soft:h[1]}},b=!1),!b&&ci(h))){let y=h;h=(M,T,O)=>T==null?eo:li(T,O,y)}u.range=te(h||(p?e0:i==L?u.distr==3?n0:u.
distr==4?r0:Lp:u.distr==3?Rp:u.distr==4?Ip:t0)),u.auto=te(b?!1:u.auto),u.clamp=te(u.clamp||zv),u._min=u._max=null,u.valToPct=
X(u)}}}W("x"),W("y"),o==1&&w.forEach(i=>{W(i.scale)}),P.forEach(i=>{W(i.scale)});for(let i in e.scales)W(i);let A=S[L],B=A.
distr,C,q;A.ori==0?(At(m,dg),C=l,q=a):(At(m,mg),C=a,q=l);let U={};for(let i in S){let u=S[i];(u.min!=null||u.max!=null)&&
(U[i]={min:u.min,max:u.max},u.min=u.max=null)}let ne=e.tzDate||(i=>new Date(Ue(i/F))),H=e.fmtDate||ma,ft=F==1?dv(ne):gv(
ne),ke=Rf(ne,Lf(F==1?pv:hv,H)),le=Vf(ne,If(_v,H)),me=[],Q=r.legend=Le({},wv,e.legend),V=r.cursor=Le({},Av,{drag:{y:o==2}},
e.cursor),Re=Q.show,nt=V.show,Me=Q.markers;Q.idxs=me,Me.width=te(Me.width),Me.dash=te(Me.dash),Me.stroke=te(Me.stroke),Me.
fill=te(Me.fill);let fe,Ht,_t,Ne=[],en=[],gn,Pt=!1,Tn={};if(Q.live){let i=w[1]?w[1].values:null;Pt=i!=null,gn=Pt?i(r,1,0):
{_:0};for(let u in gn)Tn[u]=aa}if(Re)if(fe=Jt("table",kg,m),_t=Jt("tbody",null,fe),Q.mount(r,fe),Pt){Ht=Jt("thead",null,
fe,_t);let i=Jt("tr",null,Ht);Jt("th",null,i);for(var dr in gn)Jt("th",df,i).textContent=dr}else At(fe,Tg),Q.live&&At(fe,
Mg);let mr={show:!0},so={show:!1};function Zo(i,u){if(u==0&&(Pt||!Q.live||o==2))return eo;let f=[],p=Jt("tr",Ag,_t,_t.childNodes[u]);
At(p,i.class),i.show||At(p,ur);let h=Jt("th",null,p);if(Me.show){let M=It(Eg,h);if(u>0){let T=Me.width(r,u);T&&(M.style.
border=T+"px "+Me.dash(r,u)+" "+Me.stroke(r,u)),M.style.background=Me.fill(r,u)}}let b=It(df,h);i.label instanceof HTMLElement?
b.appendChild(i.label):b.textContent=i.label,u>0&&(Me.show||(b.style.color=i.width>0?Me.stroke(r,u):Me.fill(r,u)),rt("cl\
ick",h,M=>{if(V._lock)return;Un(M);let T=w.indexOf(i);if((M.ctrlKey||M.metaKey)!=Q.isolate){let O=w.some((D,R)=>R>0&&R!=
T&&D.show);w.forEach((D,R)=>{R>0&&rn(R,O?R==T?mr:so:mr,!0,Ce.setSeries)})}else rn(T,{show:!i.show},!0,Ce.setSeries)},!1),
_r&&rt(vf,h,M=>{V._lock||(Un(M),rn(w.indexOf(i),Pr,!0,Ce.setSeries))},!1));for(var y in gn){let M=Jt("td",Ng,p);M.textContent=
"--",f.push(M)}return[p,f]}let Rn=new Map;function rt(i,u,f,p=!0){let h=Rn.get(u)||{},b=V.bind[i](r,u,f,p);b&&(cr(i,u,h[i]=
b),Rn.set(u,h))}function hr(i,u,f){let p=Rn.get(u)||{};for(let h in p)(i==null||h==i)&&(ea(h,u,p[h]),delete p[h]);i==null&&
Rn.delete(u)}let vn=0,In=0,J=0,$=0,be=0,Ie=0,gr=be,Vn=Ie,tn=J,zn=$,bt=0,Ot=0,pt=0,Ut=0;r.bbox={};let bi=!1,Jo=!1,vr=!1,Hn=!1,
Xo=!1,Ft=!1;function xi(i,u,f){(f||i!=r.width||u!=r.height)&&Ea(i,u),Sr(!1),vr=!0,Jo=!0,kr()}function Ea(i,u){r.width=vn=
J=i,r.height=In=$=u,be=Ie=0,ld(),id();let f=r.bbox;bt=f.left=sr(be*ce,.5),Ot=f.top=sr(Ie*ce,.5),pt=f.width=sr(J*ce,.5),Ut=
f.height=sr($*ce,.5)}let nd=3;function rd(){let i=!1,u=0;for(;!i;){u++;let f=hd(u),p=gd(u);i=u==nd||f&&p,i||(Ea(r.width,
r.height),Jo=!0)}}function od({width:i,height:u}){xi(i,u)}r.setSize=od;function ld(){let i=!1,u=!1,f=!1,p=!1;P.forEach((h,b)=>{
if(h.show&&h._show){let{side:y,_size:M}=h,T=y%2,O=h.label!=null?h.labelSize:0,D=M+O;D>0&&(T?(J-=D,y==3?(be+=D,p=!0):f=!0):
($-=D,y==0?(Ie+=D,i=!0):u=!0))}}),Wn[0]=i,Wn[1]=f,Wn[2]=u,Wn[3]=p,J-=An[1]+An[3],be+=An[3],$-=An[2]+An[0],Ie+=An[0]}function id(){
let i=be+J,u=Ie+$,f=be,p=Ie;function h(b,y){switch(b){case 1:return i+=y,i-y;case 2:return u+=y,u-y;case 3:return f-=y,f+
y;case 0:return p-=y,p+y}}P.forEach((b,y)=>{if(b.show&&b._show){let M=b.side;b._pos=h(M,b._size),b.label!=null&&(b._lpos=
h(M,b.labelSize))}})}if(V.dataIdx==null){let i=V.hover,u=i.skip=new Set(i.skip??[]);u.add(void 0);let f=i.prox=te(i.prox),
p=i.bias??=0;V.dataIdx=(h,b,y,M)=>{if(b==0)return y;let T=y,O=f(h,b,y,M)??ve,D=O>=0&&O<ve,R=A.ori==0?J:$,Y=V.left,ae=t[0],
ie=t[b];if(u.has(ie[y])){T=null;let ee=null,j=null,z;if(p==0||p==-1)for(z=y;ee==null&&z-- >0;)u.has(ie[z])||(ee=z);if(p==
0||p==1)for(z=y;j==null&&z++<ie.length;)u.has(ie[z])||(j=z);if(ee!=null||j!=null)if(D){let ye=ee==null?-1/0:C(ae[ee],A,R,
0),Pe=j==null?1/0:C(ae[j],A,R,0),Ke=Y-ye,he=Pe-Y;Ke<=he?Ke<=O&&(T=ee):he<=O&&(T=j)}else T=j==null?ee:ee==null?j:y-ee<=j-
y?ee:j}else D&&We(Y-C(ae[y],A,R,0))>O&&(T=null);return T}}let Un=i=>{V.event=i};V.idxs=me,V._lock=!1;let et=V.points;et.
show=te(et.show),et.size=te(et.size),et.stroke=te(et.stroke),et.width=te(et.width),et.fill=te(et.fill);let nn=r.focus=Le(
{},e.focus||{alpha:.3},V.focus),_r=nn.prox>=0,br=_r&&et.one,Ct=[],xr=[],wr=[];function Na(i,u){let f=et.show(r,u);if(f instanceof
HTMLElement)return At(f,Sg),At(f,i.class),hn(f,-10,-10,J,$),k.insertBefore(f,Ct[u]),f}function Pa(i,u){if(o==1||u>0){let f=o==
1&&S[i.scale].time,p=i.value;i.value=f?Ff(p)?Vf(ne,If(p,H)):p||le:p||Rv,i.label=i.label||(f?Nv:Ev)}if(br||u>0){i.width=i.
width==null?1:i.width,i.paths=i.paths||Jv||Hg,i.fillTo=te(i.fillTo||Uv),i.pxAlign=+se(i.pxAlign,N),i.pxRound=Yf(i.pxAlign),
i.stroke=te(i.stroke||null),i.fill=te(i.fill||null),i._stroke=i._fill=i._paths=i._focus=null;let f=Iv(ct(1,i.width),1),p=i.
points=Le({},{size:f,width:ct(1,f*.2),stroke:i.stroke,space:f*2,paths:Xv,_stroke:null,_fill:null},i.points);p.show=te(p.
show),p.filter=te(p.filter),p.fill=te(p.fill),p.stroke=te(p.stroke),p.paths=te(p.paths),p.pxAlign=i.pxAlign}if(Re){let f=Zo(
i,u);Ne.splice(u,0,f[0]),en.splice(u,0,f[1]),Q.values.push(null)}if(nt){me.splice(u,0,null);let f=null;br?u==0&&(f=Na(i,
u)):u>0&&(f=Na(i,u)),Ct.splice(u,0,f),xr.splice(u,0,0),wr.splice(u,0,0)}Ye("addSeries",u)}function sd(i,u){u=u??w.length,
i=o==1?ia(i,u,Hf,jf):ia(i,u,{},Bf),w.splice(u,0,i),Pa(w[u],u)}r.addSeries=sd;function ad(i){if(w.splice(i,1),Re){Q.values.
splice(i,1),en.splice(i,1);let u=Ne.splice(i,1)[0];hr(null,u.firstChild),u.remove()}nt&&(me.splice(i,1),Ct.splice(i,1)[0].
remove(),xr.splice(i,1),wr.splice(i,1)),Ye("delSeries",i)}r.delSeries=ad;let Wn=[!1,!1,!1,!1];function ud(i,u){if(i._show=
i.show,i.show){let f=i.side%2,p=S[i.scale];p==null&&(i.scale=f?w[1].scale:L,p=S[i.scale]);let h=p.time;i.size=te(i.size),
i.space=te(i.space),i.rotate=te(i.rotate),$n(i.incrs)&&i.incrs.forEach(y=>{!Ln.has(y)&&Ln.set(y,sp(y))}),i.incrs=te(i.incrs||
(p.distr==2?uv:h?F==1?fv:mv:ar)),i.splits=te(i.splits||(h&&p.distr==1?ft:p.distr==3?na:p.distr==4?Fv:Ov)),i.stroke=te(i.
stroke),i.grid.stroke=te(i.grid.stroke),i.ticks.stroke=te(i.ticks.stroke),i.border.stroke=te(i.border.stroke);let b=i.values;
i.values=$n(b)&&!$n(b[0])?te(b):h?$n(b)?Rf(ne,Lf(b,H)):Ff(b)?vv(ne,b):b||ke:b||Pv,i.filter=te(i.filter||(p.distr>=3&&p.log==
10?$v:p.distr==3&&p.log==2?Lv:lp)),i.font=Xf(i.font),i.labelFont=Xf(i.labelFont),i._size=i.size(r,null,u,0),i._space=i._rotate=
i._incrs=i._found=i._splits=i._values=null,i._size>0&&(Wn[u]=!0,i._el=It(bg,x))}}function ao(i,u,f,p){let[h,b,y,M]=f,T=u%
2,O=0;return T==0&&(M||b)&&(O=u==0&&!h||u==2&&!y?Ue(zf.size/3):0),T==1&&(h||y)&&(O=u==1&&!b||u==3&&!M?Ue(Wf.size/2):0),O}
let Oa=r.padding=(e.padding||[ao,ao,ao,ao]).map(i=>te(se(i,ao))),An=r._padding=Oa.map((i,u)=>i(r,u,Wn,0)),Je,Ge=null,Be=null,
Qo=o==1?w[0].idxs:null,Wt=null,uo=!1;function Fa(i,u){if(t=i??[],r.data=r._data=t,o==2){Je=0;for(let f=1;f<w.length;f++)
Je+=t[f][0].length}else{t.length==0&&(r.data=r._data=t=[[]]),Wt=t[0],Je=Wt.length;let f=t;if(B==2){f=t.slice();let p=f[0]=
Array(Je);for(let h=0;h<Je;h++)p[h]=h}r._data=t=f}if(Sr(!0),Ye("setData"),B==2&&(vr=!0),u!==!1){let f=A;f.auto(r,uo)?wi():
Nn(L,f.min,f.max),Hn=Hn||V.left>=0,Ft=!0,kr()}}r.setData=Fa;function wi(){uo=!0;let i,u;o==1&&(Je>0?(Ge=Qo[0]=0,Be=Qo[1]=
Je-1,i=t[0][Ge],u=t[0][Be],B==2?(i=Ge,u=Be):i==u&&(B==3?[i,u]=ai(i,i,A.log,!1):B==4?[i,u]=ca(i,i,A.log,!1):A.time?u=i+Ue(
86400/F):[i,u]=li(i,u,fa,!0))):(Ge=Qo[0]=i=null,Be=Qo[1]=u=null)),Nn(L,i,u)}let el,yr,yi,Si,ki,Mi,Ti,Ai,Ei,dt;function Ca(i,u,f,p,h,b){
i??=hf,f??=da,p??="butt",h??=hf,b??="round",i!=el&&(_.strokeStyle=el=i),h!=yr&&(_.fillStyle=yr=h),u!=yi&&(_.lineWidth=yi=
u),b!=ki&&(_.lineJoin=ki=b),p!=Mi&&(_.lineCap=Mi=p),f!=Si&&_.setLineDash(Si=f)}function Da(i,u,f,p){u!=yr&&(_.fillStyle=
yr=u),i!=Ti&&(_.font=Ti=i),f!=Ai&&(_.textAlign=Ai=f),p!=Ei&&(_.textBaseline=Ei=p)}function Ni(i,u,f,p,h=0){if(p.length>0&&
i.auto(r,uo)&&(u==null||u.min==null)){let b=se(Ge,0),y=se(Be,p.length-1),M=f.min==null?$g(p,b,y,h,i.distr==3):[f.min,f.max];
i.min=Qt(i.min,f.min=M[0]),i.max=ct(i.max,f.max=M[1])}}let $a={min:null,max:null};function cd(){for(let p in S){let h=S[p];
U[p]==null&&(h.min==null||U[L]!=null&&h.auto(r,uo))&&(U[p]=$a)}for(let p in S){let h=S[p];U[p]==null&&h.from!=null&&U[h.
from]!=null&&(U[p]=$a)}U[L]!=null&&Sr(!0);let i={};for(let p in U){let h=U[p];if(h!=null){let b=i[p]=to(S[p],Gg);if(h.min!=
null)Le(b,h);else if(p!=L||o==2)if(Je==0&&b.from==null){let y=b.range(r,null,null,p);b.min=y[0],b.max=y[1]}else b.min=ve,
b.max=-ve}}if(Je>0){w.forEach((p,h)=>{if(o==1){let b=p.scale,y=U[b];if(y==null)return;let M=i[b];if(h==0){let T=M.range(
r,M.min,M.max,b);M.min=T[0],M.max=T[1],Ge=Xt(M.min,t[0]),Be=Xt(M.max,t[0]),Be-Ge>1&&(t[0][Ge]<M.min&&Ge++,t[0][Be]>M.max&&
Be--),p.min=Wt[Ge],p.max=Wt[Be]}else p.show&&p.auto&&Ni(M,y,p,t[h],p.sorted);p.idxs[0]=Ge,p.idxs[1]=Be}else if(h>0&&p.show&&
p.auto){let[b,y]=p.facets,M=b.scale,T=y.scale,[O,D]=t[h],R=i[M],Y=i[T];R!=null&&Ni(R,U[M],b,O,b.sorted),Y!=null&&Ni(Y,U[T],
y,D,y.sorted),p.min=y.min,p.max=y.max}});for(let p in i){let h=i[p],b=U[p];if(h.from==null&&(b==null||b.min==null)){let y=h.
range(r,h.min==ve?null:h.min,h.max==-ve?null:h.max,p);h.min=y[0],h.max=y[1]}}}for(let p in i){let h=i[p];if(h.from!=null){
let b=i[h.from];if(b.min==null)h.min=h.max=null;else{let y=h.range(r,b.min,b.max,p);h.min=y[0],h.max=y[1]}}}let u={},f=!1;
for(let p in i){let h=i[p],b=S[p];if(b.min!=h.min||b.max!=h.max){b.min=h.min,b.max=h.max;let y=b.distr;b._min=y==3?Sn(b.
min):y==4?qs(b.min,b.asinh):y==100?b.fwd(b.min):b.min,b._max=y==3?Sn(b.max):y==4?qs(b.max,b.asinh):y==100?b.fwd(b.max):b.
max,u[p]=f=!0}}if(f){w.forEach((p,h)=>{o==2?h>0&&u.y&&(p._paths=null):u[p.scale]&&(p._paths=null)});for(let p in u)vr=!0,
Ye("setScale",p);nt&&V.left>=0&&(Hn=Ft=!0)}for(let p in U)U[p]=null}function fd(i){let u=ta(Ge-1,0,Je-1),f=ta(Be+1,0,Je-
1);for(;i[u]==null&&u>0;)u--;for(;i[f]==null&&f<Je-1;)f++;return[u,f]}function pd(){if(Je>0){let i=w.some(u=>u._focus)&&
dt!=nn.alpha;i&&(_.globalAlpha=dt=nn.alpha),w.forEach((u,f)=>{if(f>0&&u.show&&(La(f,!1),La(f,!0),u._paths==null)){let p=dt;
dt!=u.alpha&&(_.globalAlpha=dt=u.alpha);let h=o==2?[0,t[f][0].length-1]:fd(t[f]);u._paths=u.paths(r,f,h[0],h[1]),dt!=p&&
(_.globalAlpha=dt=p)}}),w.forEach((u,f)=>{if(f>0&&u.show){let p=dt;dt!=u.alpha&&(_.globalAlpha=dt=u.alpha),u._paths!=null&&
Ra(f,!1);{let h=u._paths!=null?u._paths.gaps:null,b=u.points.show(r,f,Ge,Be,h),y=u.points.filter(r,f,b,h);(b||y)&&(u.points.
_paths=u.points.paths(r,f,Ge,Be,y),Ra(f,!0))}dt!=p&&(_.globalAlpha=dt=p),Ye("drawSeries",f)}}),i&&(_.globalAlpha=dt=1)}}
function La(i,u){let f=u?w[i].points:w[i];f._stroke=f.stroke(r,i),f._fill=f.fill(r,i)}function Ra(i,u){let f=u?w[i].points:
w[i],{stroke:p,fill:h,clip:b,flags:y,_stroke:M=f._stroke,_fill:T=f._fill,_width:O=f.width}=f._paths;O=_e(O*ce,3);let D=null,
R=O%2/2;u&&T==null&&(T=O>0?"#fff":M);let Y=f.pxAlign==1&&R>0;if(Y&&_.translate(R,R),!u){let ae=bt-O/2,ie=Ot-O/2,ee=pt+O,
j=Ut+O;D=new Path2D,D.rect(ae,ie,ee,j)}u?Pi(M,O,f.dash,f.cap,T,p,h,y,b):dd(i,M,O,f.dash,f.cap,T,p,h,y,D,b),Y&&_.translate(
-R,-R)}function dd(i,u,f,p,h,b,y,M,T,O,D){let R=!1;T!=0&&K.forEach((Y,ae)=>{if(Y.series[0]==i){let ie=w[Y.series[1]],ee=t[Y.
series[1]],j=(ie._paths||qo).band;$n(j)&&(j=Y.dir==1?j[0]:j[1]);let z,ye=null;ie.show&&j&&Rg(ee,Ge,Be)?(ye=Y.fill(r,ae)||
b,z=ie._paths.clip):j=null,Pi(u,f,p,h,ye,y,M,T,O,D,z,j),R=!0}}),R||Pi(u,f,p,h,b,y,M,T,O,D)}let Ia=no|oa;function Pi(i,u,f,p,h,b,y,M,T,O,D,R){
Ca(i,u,f,p,h),(T||O||R)&&(_.save(),T&&_.clip(T),O&&_.clip(O)),R?(M&Ia)==Ia?(_.clip(R),D&&_.clip(D),nl(h,y),tl(i,b,u)):M&
oa?(nl(h,y),_.clip(R),tl(i,b,u)):M&no&&(_.save(),_.clip(R),D&&_.clip(D),nl(h,y),_.restore(),tl(i,b,u)):(nl(h,y),tl(i,b,u)),
(T||O||R)&&_.restore()}function tl(i,u,f){f>0&&(u instanceof Map?u.forEach((p,h)=>{_.strokeStyle=el=h,_.stroke(p)}):u!=null&&
i&&_.stroke(u))}function nl(i,u){u instanceof Map?u.forEach((f,p)=>{_.fillStyle=yr=p,_.fill(f)}):u!=null&&i&&_.fill(u)}function md(i,u,f,p){
let h=P[i],b;if(p<=0)b=[0,0];else{let y=h._space=h.space(r,i,u,f,p),M=h._incrs=h.incrs(r,i,u,f,p,y);b=o0(u,f,M,p,y)}return h.
_found=b}function Oi(i,u,f,p,h,b,y,M,T,O){let D=y%2/2;N==1&&_.translate(D,D),Ca(M,y,T,O,M),_.beginPath();let R,Y,ae,ie,ee=h+
(p==0||p==3?-b:b);f==0?(Y=h,ie=ee):(R=h,ae=ee);for(let j=0;j<i.length;j++)u[j]!=null&&(f==0?R=ae=i[j]:Y=ie=i[j],_.moveTo(
R,Y),_.lineTo(ae,ie));_.stroke(),N==1&&_.translate(-D,-D)}function hd(i){let u=!0;return P.forEach((f,p)=>{if(!f.show)return;
let h=S[f.scale];if(h.min==null){f._show&&(u=!1,f._show=!1,Sr(!1));return}else f._show||(u=!1,f._show=!0,Sr(!1));let b=f.
side,y=b%2,{min:M,max:T}=h,[O,D]=md(p,M,T,y==0?J:$);if(D==0)return;let R=h.distr==2,Y=f._splits=f.splits(r,p,M,T,O,D,R),
ae=h.distr==2?Y.map(z=>Wt[z]):Y,ie=h.distr==2?Wt[Y[1]]-Wt[Y[0]]:O,ee=f._values=f.values(r,f.filter(r,ae,p,D,ie),p,D,ie);
f._rotate=b==2?f.rotate(r,ee,p,D):0;let j=f._size;f._size=Vt(f.size(r,ee,p,i)),j!=null&&f._size!=j&&(u=!1)}),u}function gd(i){
let u=!0;return Oa.forEach((f,p)=>{let h=f(r,p,Wn,i);h!=An[p]&&(u=!1),An[p]=h}),u}function vd(){for(let i=0;i<P.length;i++){
let u=P[i];if(!u.show||!u._show)continue;let f=u.side,p=f%2,h,b,y=u.stroke(r,i),M=f==0||f==3?-1:1,[T,O]=u._found;if(u.label!=
null){let lt=u.labelGap*M,yt=Ue((u._lpos+lt)*ce);Da(u.labelFont[0],y,"center",f==2?"top":mf),_.save(),p==1?(h=b=0,_.translate(
yt,Ue(Ot+Ut/2)),_.rotate((f==3?-ri:ri)/2)):(h=Ue(bt+pt/2),b=yt);let jn=rp(u.label)?u.label(r,i,T,O):u.label;_.fillText(jn,
h,b),_.restore()}if(O==0)continue;let D=S[u.scale],R=p==0?pt:Ut,Y=p==0?bt:Ot,ae=u._splits,ie=D.distr==2?ae.map(lt=>Wt[lt]):
ae,ee=D.distr==2?Wt[ae[1]]-Wt[ae[0]]:T,j=u.ticks,z=u.border,ye=j.show?j.size:0,Pe=Ue(ye*ce),Ke=Ue((u.alignTo==2?u._size-
ye-u.gap:u.gap)*ce),he=u._rotate*-ri/180,Oe=E(u._pos*ce),xt=(Pe+Ke)*M,ot=Oe+xt;b=p==0?ot:0,h=p==1?ot:0;let Dt=u.font[0],
Gt=u.align==1?Zr:u.align==2?Gs:he>0?Zr:he<0?Gs:p==0?"center":f==3?Gs:Zr,ln=he||p==1?"middle":f==2?"top":mf;Da(Dt,y,Gt,ln);
let wt=u.font[1]*u.lineGap,$t=ae.map(lt=>E(c(lt,D,R,Y))),Bt=u._values;for(let lt=0;lt<Bt.length;lt++){let yt=Bt[lt];if(yt!=
null){p==0?h=$t[lt]:b=$t[lt],yt=""+yt;let jn=yt.indexOf(`
`)==-1?[yt]:yt.split(/\n/gm);for(let it=0;it<jn.length;it++){let ru=jn[it];he?(_.save(),_.translate(h,b+it*wt),_.rotate(
he),_.fillText(ru,0,0),_.restore()):_.fillText(ru,h,b+it*wt)}}}j.show&&Oi($t,j.filter(r,ie,i,O,ee),p,f,Oe,Pe,_e(j.width*
ce,3),j.stroke(r,i),j.dash,j.cap);let sn=u.grid;sn.show&&Oi($t,sn.filter(r,ie,i,O,ee),p,p==0?2:1,p==0?Ot:bt,p==0?Ut:pt,_e(
sn.width*ce,3),sn.stroke(r,i),sn.dash,sn.cap),z.show&&Oi([Oe],[1],p==0?1:0,p==0?1:2,p==1?Ot:bt,p==1?Ut:pt,_e(z.width*ce,
3),z.stroke(r,i),z.dash,z.cap)}Ye("drawAxes")}function Sr(i){w.forEach((u,f)=>{f>0&&(u._paths=null,i&&(o==1?(u.min=null,
u.max=null):u.facets.forEach(p=>{p.min=null,p.max=null})))})}let rl=!1,Fi=!1,co=[];function _d(){Fi=!1;for(let i=0;i<co.
length;i++)Ye(...co[i]);co.length=0}function kr(){rl||(Jg(Va),rl=!0)}function bd(i,u=!1){rl=!0,Fi=u,i(r),Va(),u&&co.length>
0&&queueMicrotask(_d)}r.batch=bd;function Va(){if(bi&&(cd(),bi=!1),vr&&(rd(),vr=!1),Jo){if(Se(v,Zr,be),Se(v,"top",Ie),Se(
v,Wo,J),Se(v,Go,$),Se(k,Zr,be),Se(k,"top",Ie),Se(k,Wo,J),Se(k,Go,$),Se(x,Wo,vn),Se(x,Go,In),g.width=Ue(vn*ce),g.height=Ue(
In*ce),P.forEach(({_el:i,_show:u,_size:f,_pos:p,side:h})=>{if(i!=null)if(u){let b=h===3||h===0?f:0,y=h%2==1;Se(i,y?"left":
"top",p-b),Se(i,y?"width":"height",f),Se(i,y?"top":"left",y?Ie:be),Se(i,y?"height":"width",y?$:J),Qs(i,ur)}else At(i,ur)}),
el=yr=yi=ki=Mi=Ti=Ai=Ei=Si=null,dt=1,mo(!0),be!=gr||Ie!=Vn||J!=tn||$!=zn){Sr(!1);let i=J/tn,u=$/zn;if(nt&&!Hn&&V.left>=0){
V.left*=i,V.top*=u,Mr&&hn(Mr,Ue(V.left),0,J,$),Tr&&hn(Tr,0,Ue(V.top),J,$);for(let f=0;f<Ct.length;f++){let p=Ct[f];p!=null&&
(xr[f]*=i,wr[f]*=u,hn(p,Vt(xr[f]),Vt(wr[f]),J,$))}}if(we.show&&!Xo&&we.left>=0&&we.width>0){we.left*=i,we.width*=i,we.top*=
u,we.height*=u;for(let f in Ii)Se(Nr,f,we[f])}gr=be,Vn=Ie,tn=J,zn=$}Ye("setSize"),Jo=!1}vn>0&&In>0&&(_.clearRect(0,0,g.width,
g.height),Ye("drawClear"),G.forEach(i=>i()),Ye("draw")),we.show&&Xo&&(ol(we),Xo=!1),nt&&Hn&&(Bn(null,!0,!1),Hn=!1),Q.show&&
Q.live&&Ft&&(Li(),Ft=!1),d||(d=!0,r.status=1,Ye("ready")),uo=!1,rl=!1}r.redraw=(i,u)=>{vr=u||!1,i!==!1?Nn(L,A.min,A.max):
kr()};function Ci(i,u){let f=S[i];if(f.from==null){if(Je==0){let p=f.range(r,u.min,u.max,i);u.min=p[0],u.max=p[1]}if(u.min>
u.max){let p=u.min;u.min=u.max,u.max=p}if(Je>1&&u.min!=null&&u.max!=null&&u.max-u.min<1e-16)return;i==L&&f.distr==2&&Je>
0&&(u.min=Xt(u.min,t[0]),u.max=Xt(u.max,t[0]),u.min==u.max&&u.max++),U[i]=u,bi=!0,kr()}}r.setScale=Ci;let Di,$i,Mr,Tr,za,
Ha,Ar,Er,Ua,Wa,xe,Te,En=!1,Xe=V.drag,je=Xe.x,qe=Xe.y;nt&&(V.x&&(Di=It(wg,k)),V.y&&($i=It(yg,k)),A.ori==0?(Mr=Di,Tr=$i):(Mr=
$i,Tr=Di),xe=V.left,Te=V.top);let we=r.select=Le({show:!0,over:!0,left:0,width:0,top:0,height:0},e.select),Nr=we.show?It(
xg,we.over?k:v):null;function ol(i,u){if(we.show){for(let f in i)we[f]=i[f],f in Ii&&Se(Nr,f,i[f]);u!==!1&&Ye("setSelect")}}
r.setSelect=ol;function xd(i){if(w[i].show)Re&&Qs(Ne[i],ur);else if(Re&&At(Ne[i],ur),nt){let f=br?Ct[0]:Ct[i];f!=null&&hn(
f,-10,-10,J,$)}}function Nn(i,u,f){Ci(i,{min:u,max:f})}function rn(i,u,f,p){u.focus!=null&&Md(i),u.show!=null&&w.forEach(
(h,b)=>{b>0&&(i==b||i==null)&&(h.show=u.show,xd(b),o==2?(Nn(h.facets[0].scale,null,null),Nn(h.facets[1].scale,null,null)):
Nn(h.scale,null,null),kr())}),f!==!1&&Ye("setSeries",i,u),p&&ho("setSeries",r,i,u)}r.setSeries=rn;function wd(i,u){Le(K[i],
u)}function yd(i,u){i.fill=te(i.fill||null),i.dir=se(i.dir,-1),u=u??K.length,K.splice(u,0,i)}function Sd(i){i==null?K.length=
0:K.splice(i,1)}r.addBand=yd,r.setBand=wd,r.delBand=Sd;function kd(i,u){w[i].alpha=u,nt&&Ct[i]!=null&&(Ct[i].style.opacity=
u),Re&&Ne[i]&&(Ne[i].style.opacity=u)}let _n,Pn,Gn,Pr={focus:!0};function Md(i){if(i!=Gn){let u=i==null,f=nn.alpha!=1;w.
forEach((p,h)=>{if(o==1||h>0){let b=u||h==0||h==i;p._focus=u?null:b,f&&kd(h,b?1:nn.alpha)}}),Gn=i,f&&kr()}}Re&&_r&&rt(_f,
fe,i=>{V._lock||(Un(i),Gn!=null&&rn(null,Pr,!0,Ce.setSeries))});function on(i,u,f){let p=S[u];f&&(i=i/ce-(p.ori==1?Ie:be));
let h=J;p.ori==1&&(h=$,i=h-i),p.dir==-1&&(i=h-i);let b=p._min,y=p._max,M=i/h,T=b+(y-b)*M,O=p.distr;return O==3?Qr(10,T):
O==4?Vg(T,p.asinh):O==100?p.bwd(T):T}function Td(i,u){let f=on(i,L,u);return Xt(f,t[0],Ge,Be)}r.valToIdx=i=>Xt(i,t[0]),r.
posToIdx=Td,r.posToVal=on,r.valToPos=(i,u,f)=>S[u].ori==0?l(i,S[u],f?pt:J,f?bt:0):a(i,S[u],f?Ut:$,f?Ot:0),r.setCursor=(i,u,f)=>{
xe=i.left,Te=i.top,Bn(null,u,f)};function Ga(i,u){Se(Nr,Zr,we.left=i),Se(Nr,Wo,we.width=u)}function Ba(i,u){Se(Nr,"top",
we.top=i),Se(Nr,Go,we.height=u)}let fo=A.ori==0?Ga:Ba,po=A.ori==1?Ga:Ba;function Ad(){if(Re&&Q.live)for(let i=o==2?1:0;i<
w.length;i++){if(i==0&&Pt)continue;let u=Q.values[i],f=0;for(let p in u)en[i][f++].firstChild.nodeValue=u[p]}}function Li(i,u){
if(i!=null&&(i.idxs?i.idxs.forEach((f,p)=>{me[p]=f}):Wg(i.idx)||me.fill(i.idx),Q.idx=me[0]),Re&&Q.live){for(let f=0;f<w.
length;f++)(f>0||o==1&&!Pt)&&Ed(f,me[f]);Ad()}Ft=!1,u!==!1&&Ye("setLegend")}r.setLegend=Li;function Ed(i,u){let f=w[i],p=i==
0&&B==2?Wt:t[i],h;Pt?h=f.values(r,i,u)??Tn:(h=f.value(r,u==null?null:p[u],i,u),h=h==null?Tn:{_:h}),Q.values[i]=h}function Bn(i,u,f){
Ua=xe,Wa=Te,[xe,Te]=V.move(r,xe,Te),V.left=xe,V.top=Te,nt&&(Mr&&hn(Mr,Ue(xe),0,J,$),Tr&&hn(Tr,0,Ue(Te),J,$));let p,h=Ge>
Be;_n=ve,Pn=null;let b=A.ori==0?J:$,y=A.ori==1?J:$;if(xe<0||Je==0||h){p=V.idx=null;for(let M=0;M<w.length;M++){let T=Ct[M];
T!=null&&hn(T,-10,-10,J,$)}_r&&rn(null,Pr,!0,i==null&&Ce.setSeries),Q.live&&(me.fill(p),Ft=!0)}else{let M,T,O;o==1&&(M=A.
ori==0?xe:Te,T=on(M,L),p=V.idx=Xt(T,t[0],Ge,Be),O=C(t[0][p],A,b,0));let D=-10,R=-10,Y=0,ae=0,ie=!0,ee="",j="";for(let z=o==
2?1:0;z<w.length;z++){let ye=w[z],Pe=me[z],Ke=Pe==null?null:o==1?t[z][Pe]:t[z][1][Pe],he=V.dataIdx(r,z,p,T),Oe=he==null?
null:o==1?t[z][he]:t[z][1][he];if(Ft=Ft||Oe!=Ke||he!=Pe,me[z]=he,z>0&&ye.show){let xt=he==null?-10:he==p?O:C(o==1?t[0][he]:
t[z][0][he],A,b,0),ot=Oe==null?-10:q(Oe,o==1?S[ye.scale]:S[ye.facets[1].scale],y,0);if(_r&&Oe!=null){let Dt=A.ori==1?xe:
Te,Gt=We(nn.dist(r,z,he,ot,Dt));if(Gt<_n){let ln=nn.bias;if(ln!=0){let wt=on(Dt,ye.scale),$t=Oe>=0?1:-1,Bt=wt>=0?1:-1;Bt==
$t&&(Bt==1?ln==1?Oe>=wt:Oe<=wt:ln==1?Oe<=wt:Oe>=wt)&&(_n=Gt,Pn=z)}else _n=Gt,Pn=z}}if(Ft||br){let Dt,Gt;A.ori==0?(Dt=xt,
Gt=ot):(Dt=ot,Gt=xt);let ln,wt,$t,Bt,sn,lt,yt=!0,jn=et.bbox;if(jn!=null){yt=!1;let it=jn(r,z);$t=it.left,Bt=it.top,ln=it.
width,wt=it.height}else $t=Dt,Bt=Gt,ln=wt=et.size(r,z);if(lt=et.fill(r,z),sn=et.stroke(r,z),br)z==Pn&&_n<=nn.prox&&(D=$t,
R=Bt,Y=ln,ae=wt,ie=yt,ee=lt,j=sn);else{let it=Ct[z];it!=null&&(xr[z]=$t,wr[z]=Bt,Mf(it,ln,wt,yt),Sf(it,lt,sn),hn(it,Vt($t),
Vt(Bt),J,$))}}}}if(br){let z=nn.prox,ye=Gn==null?_n<=z:_n>z||Pn!=Gn;if(Ft||ye){let Pe=Ct[0];Pe!=null&&(xr[0]=D,wr[0]=R,Mf(
Pe,Y,ae,ie),Sf(Pe,ee,j),hn(Pe,Vt(D),Vt(R),J,$))}}}if(we.show&&En)if(i!=null){let[M,T]=Ce.scales,[O,D]=Ce.match,[R,Y]=i.cursor.
sync.scales,ae=i.cursor.drag;if(je=ae._x,qe=ae._y,je||qe){let{left:ie,top:ee,width:j,height:z}=i.select,ye=i.scales[R].ori,
Pe=i.posToVal,Ke,he,Oe,xt,ot,Dt=M!=null&&O(M,R),Gt=T!=null&&D(T,Y);Dt&&je?(ye==0?(Ke=ie,he=j):(Ke=ee,he=z),Oe=S[M],xt=C(
Pe(Ke,R),Oe,b,0),ot=C(Pe(Ke+he,R),Oe,b,0),fo(Qt(xt,ot),We(ot-xt))):fo(0,b),Gt&&qe?(ye==1?(Ke=ie,he=j):(Ke=ee,he=z),Oe=S[T],
xt=q(Pe(Ke,Y),Oe,y,0),ot=q(Pe(Ke+he,Y),Oe,y,0),po(Qt(xt,ot),We(ot-xt))):po(0,y)}else Vi()}else{let M=We(Ua-za),T=We(Wa-Ha);
if(A.ori==1){let Y=M;M=T,T=Y}je=Xe.x&&M>=Xe.dist,qe=Xe.y&&T>=Xe.dist;let O=Xe.uni;O!=null?je&&qe&&(je=M>=O,qe=T>=O,!je&&
!qe&&(T>M?qe=!0:je=!0)):Xe.x&&Xe.y&&(je||qe)&&(je=qe=!0);let D,R;je&&(A.ori==0?(D=Ar,R=xe):(D=Er,R=Te),fo(Qt(D,R),We(R-D)),
qe||po(0,y)),qe&&(A.ori==1?(D=Ar,R=xe):(D=Er,R=Te),po(Qt(D,R),We(R-D)),je||fo(0,b)),!je&&!qe&&(fo(0,0),po(0,0))}if(Xe._x=
je,Xe._y=qe,i==null){if(f){if(nu!=null){let[M,T]=Ce.scales;Ce.values[0]=M!=null?on(A.ori==0?xe:Te,M):null,Ce.values[1]=T!=
null?on(A.ori==1?xe:Te,T):null}ho(Bs,r,xe,Te,J,$,p)}if(_r){let M=f&&Ce.setSeries,T=nn.prox;Gn==null?_n<=T&&rn(Pn,Pr,!0,M):
_n>T?rn(null,Pr,!0,M):Pn!=Gn&&rn(Pn,Pr,!0,M)}}Ft&&(Q.idx=p,Li()),u!==!1&&Ye("setCursor")}let On=null;Object.defineProperty(
r,"rect",{get(){return On==null&&mo(!1),On}});function mo(i=!1){i?On=null:(On=k.getBoundingClientRect(),Ye("syncRect",On))}
function ja(i,u,f,p,h,b,y){V._lock||En&&i!=null&&i.movementX==0&&i.movementY==0||(Ri(i,u,f,p,h,b,y,!1,i!=null),i!=null?Bn(
null,!0,!0):Bn(u,!0,!1))}function Ri(i,u,f,p,h,b,y,M,T){if(On==null&&mo(!1),Un(i),i!=null)f=i.clientX-On.left,p=i.clientY-
On.top;else{if(f<0||p<0){xe=-10,Te=-10;return}let[O,D]=Ce.scales,R=u.cursor.sync,[Y,ae]=R.values,[ie,ee]=R.scales,[j,z]=Ce.
match,ye=u.axes[0].side%2==1,Pe=A.ori==0?J:$,Ke=A.ori==1?J:$,he=ye?b:h,Oe=ye?h:b,xt=ye?p:f,ot=ye?f:p;if(ie!=null?f=j(O,ie)?
c(Y,S[O],Pe,0):-10:f=Pe*(xt/he),ee!=null?p=z(D,ee)?c(ae,S[D],Ke,0):-10:p=Ke*(ot/Oe),A.ori==1){let Dt=f;f=p,p=Dt}}T&&(u==
null||u.cursor.event.type==Bs)&&((f<=1||f>=J-1)&&(f=sr(f,J)),(p<=1||p>=$-1)&&(p=sr(p,$))),M?(za=f,Ha=p,[Ar,Er]=V.move(r,
f,p)):(xe=f,Te=p)}let Ii={width:0,height:0,left:0,top:0};function Vi(){ol(Ii,!1)}let qa,Ya,Ka,Za;function Ja(i,u,f,p,h,b,y){
En=!0,je=qe=Xe._x=Xe._y=!1,Ri(i,u,f,p,h,b,y,!0,!1),i!=null&&(rt(js,Js,Xa,!1),ho(gf,r,Ar,Er,J,$,null));let{left:M,top:T,width:O,
height:D}=we;qa=M,Ya=T,Ka=O,Za=D}function Xa(i,u,f,p,h,b,y){En=Xe._x=Xe._y=!1,Ri(i,u,f,p,h,b,y,!1,!0);let{left:M,top:T,width:O,
height:D}=we,R=O>0||D>0,Y=qa!=M||Ya!=T||Ka!=O||Za!=D;if(R&&Y&&ol(we),Xe.setScale&&R&&Y){let ae=M,ie=O,ee=T,j=D;if(A.ori==
1&&(ae=T,ie=D,ee=M,j=O),je&&Nn(L,on(ae,L),on(ae+ie,L)),qe)for(let z in S){let ye=S[z];z!=L&&ye.from==null&&ye.min!=ve&&Nn(
z,on(ee+j,z),on(ee,z))}Vi()}else V.lock&&(V._lock=!V._lock,Bn(u,!0,i!=null));i!=null&&(hr(js,Js),ho(js,r,xe,Te,J,$,null))}
function Nd(i,u,f,p,h,b,y){if(V._lock)return;Un(i);let M=En;if(En){let T=!0,O=!0,D=10,R,Y;A.ori==0?(R=je,Y=qe):(R=qe,Y=je),
R&&Y&&(T=xe<=D||xe>=J-D,O=Te<=D||Te>=$-D),R&&T&&(xe=xe<Ar?0:J),Y&&O&&(Te=Te<Er?0:$),Bn(null,!0,!0),En=!1}xe=-10,Te=-10,me.
fill(null),Bn(null,!0,!0),M&&(En=M)}function Qa(i,u,f,p,h,b,y){V._lock||(Un(i),wi(),Vi(),i!=null&&ho(bf,r,xe,Te,J,$,null))}
function eu(){P.forEach(l0),xi(r.width,r.height,!0)}cr(oi,Xr,eu);let Or={};Or.mousedown=Ja,Or.mousemove=ja,Or.mouseup=Xa,
Or.dblclick=Qa,Or.setSeries=(i,u,f,p)=>{let h=Ce.match[2];f=h(r,u,f),f!=-1&&rn(f,p,!0,!1)},nt&&(rt(gf,k,Ja),rt(Bs,k,ja),
rt(vf,k,i=>{Un(i),mo(!1)}),rt(_f,k,Nd),rt(bf,k,Qa),la.add(r),r.syncRect=mo);let ll=r.hooks=e.hooks||{};function Ye(i,u,f){
Fi?co.push([i,u,f]):i in ll&&ll[i].forEach(p=>{p.call(null,r,u,f)})}(e.plugins||[]).forEach(i=>{for(let u in i.hooks)ll[u]=
(ll[u]||[]).concat(i.hooks[u])});let tu=(i,u,f)=>f,Ce=Le({key:null,setSeries:!1,filters:{pub:Pf,sub:Pf},scales:[L,w[1]?w[1].
scale:null],match:[Of,Of,tu],values:[null,null]},V.sync);Ce.match.length==2&&Ce.match.push(tu),V.sync=Ce;let nu=Ce.key,zi=Ap(
nu);function ho(i,u,f,p,h,b,y){Ce.filters.pub(i,u,f,p,h,b,y)&&zi.pub(i,u,f,p,h,b,y)}zi.sub(r);function Pd(i,u,f,p,h,b,y){
Ce.filters.sub(i,u,f,p,h,b,y)&&Or[i](null,u,f,p,h,b,y)}r.pub=Pd;function Od(){zi.unsub(r),la.delete(r),Rn.clear(),ea(oi,
Xr,eu),m.remove(),fe?.remove(),Ye("destroy")}r.destroy=Od;function Hi(){Ye("init",e,t),Fa(t||e.data,!1),U[L]?Ci(L,U[L]):
wi(),Xo=we.show&&(we.width>0||we.height>0),Hn=Ft=!0,xi(e.width,e.height)}return w.forEach(Pa),P.forEach(ud),n?n instanceof
HTMLElement?(n.appendChild(m),Hi()):n(r,Hi):Hi(),r}Ze.assign=Le;Ze.fmtNum=pa;Ze.rangeNum=li;Ze.rangeLog=ai;Ze.rangeAsinh=
ca;Ze.orient=pr;Ze.pxRatio=ce;Ze.join=Zg;Ze.fmtDate=ma,Ze.tzDate=sv;Ze.sync=Ap;{Ze.addGap=Wv,Ze.clipGaps=fi;let e=Ze.paths=
{points:Cp};e.linear=$p,e.stepped=jv,e.bars=qv,e.spline=Kv}var i0=8;function Vp(e){let t=[...e.touches].map(o=>o.clientX),n=Math.min(...t),r=Math.max(...t);return{fingers:t.length,
middle:(n+r)/2,spread:r-n}}function zp(e){let t=null;e.addEventListener("touchstart",n=>t=Vp(n),{passive:!0}),e.addEventListener(
"touchend",()=>t=null,{passive:!0}),e.addEventListener("touchmove",n=>{let r=Vp(n),{left:o,width:l}=e.getBoundingClientRect();
(!t||t.fingers!==r.fingers)&&(t=r),!(Math.abs(r.middle-t.middle)+Math.abs(r.spread-t.spread)<i0)&&(r.fingers>1&&r.spread>
0&&t.spread>0&&mn(t.spread/r.spread,(r.middle-o)/l),Ho((t.middle-r.middle)/l),t=r)},{passive:!0})}var Bp=220,Hp=[[],[6,3],[2,2],[8,3,2,3]],ka=8,hi=I(null),wa=e=>String(e).padStart(2,"0");function s0(e,t){let n=new Date(
e*1e3),r=`${wa(n.getHours())}:${wa(n.getMinutes())}:${wa(n.getSeconds())}`;return t?`${r}.${Math.floor(n.getMilliseconds()/
100)}`:r}var a0=(e,t,n,r,o)=>t.map(l=>s0(l,o<1));function Up(e,t,n,r,o){let[l="",a="0"]=Number(o.toPrecision(3)).toExponential().
split("e"),c=Math.max(0,Math.min(9,l.replace(/\D/g,"").length-1-Number(a))),d=Math.max(...t.map(Math.abs));return t.map(
m=>d>=1e7?m.toExponential(2):m.toFixed(c))}var Sa=e=>e.axis===1,u0=56,Ko=new Map;function Wp(e,t,n){for(let o of Ko.keys())
o.root.isConnected||Ko.delete(o);let r=Ko.get(e)??[];return r[n]=Math.max(0,...(t??[]).map(o=>7*o.length+12)),Ko.set(e,r),
Math.max(u0,...[...Ko.values()].flat())}function c0(e,t){let n=nr("dim"),r={stroke:nr("line"),width:1},l={stroke:n,font:"\
11px system-ui, sans-serif",ticks:{...r,size:4},grid:r};return[{...l,values:a0,space:70,size:28},{...l,scale:"0",values:Up,
size:Wp,space:32},{...l,scale:"1",values:t?Up:()=>[],ticks:{...l.ticks,show:t},size:Wp,space:32,side:1,show:e,grid:{show:!1}}]}
function Gp(e,t,n){if(t===null||n===null||!Number.isFinite(t)||!Number.isFinite(n))return[0,1];let r=(n-t)*.08||Math.abs(
n)*.1||1;return[t-r,n+r]}function f0(e){return e.map((t,n)=>({label:t.formula,scale:String(t.axis),stroke:nr(`series-${n%
ka}`),width:1.5,dash:Hp[Math.floor(n/2)%Hp.length],points:{size:4}}))}function p0(e,t){return{width:t,height:Bp,legend:{
show:!1},padding:[8,24,0,0],cursor:{sync:{key:"time"},drag:{x:!0,y:!1,setScale:!1},focus:{prox:-1}},scales:{x:{time:!0,auto:!1},
0:{range:Gp},1:{range:Gp}},axes:c0(pe.value.flat().some(Sa),e.some(Sa)),series:[{},...f0(e)],hooks:{setSelect:[d0],setCursor:[
m0]}}}function d0(e){let{left:t,width:n}=e.select;n<4||(lr({from:e.posToVal(t,"x"),to:e.posToVal(t+n,"x")}),e.setSelect(
{left:0,top:0,width:0,height:0},!1))}function m0(e){let{left:t}=e.cursor;hi.value=t==null||t<0?null:e.posToVal(t,"x")}var h0=(e,{
scale:t,offset:n})=>Array.from(e,r=>Number.isFinite(r)?r*t+n:null);function g0(e,t){let n=Zt(),r=e.map(o=>{let[l,a]=af(ir(
o,n),t);return[l,h0(a,o)]});return r.length===1?r[0]:Ze.join(r,r.map(o=>o.map(()=>1)))}function ya(e,t){let{from:n,to:r}=Zt();
e.batch(()=>{e.setData(g0(t,e.width),!1),e.setScale("x",{min:n,max:r})})}function v0(e,t){e.preventDefault();let{left:n,
width:r}=t.over.getBoundingClientRect();mn(e.deltaY>0?1.25:.8,(e.clientX-n)/r)}function _0(e,t){let n=new Ze(p0(t,e.clientWidth),
[[],...t.map(()=>[])],e);n.over.addEventListener("wheel",o=>v0(o,n),{passive:!1}),zp(n.over);let r=new ResizeObserver(()=>{
n.setSize({width:e.clientWidth,height:Bp})});return r.observe(e),{chart:n,destroy:()=>{r.disconnect(),n.destroy()}}}function b0(e){
let t=setInterval(()=>{!document.hidden&&Rt.value===null&&e()},250);return()=>clearInterval(t)}function jp({plot:e,onChart:t}){
let n=an(null),r=an(null),o=JSON.stringify([e,pe.value.flat().some(Sa)]);return tt(()=>{if(!n.current)return;let l=_0(n.
current,e);r.current=l.chart,t(l.chart),ya(l.chart,e);let a=b0(()=>ya(l.chart,e));return()=>{a(),l.destroy(),r.current=null,
t(null)}},[o,gs.value]),tt(()=>{r.current&&ya(r.current,e)},[Kt.value,Rt.value]),s("div",{class:"chart",ref:n,role:"img",
"aria-label":`Plot of ${e.map(l=>l.formula).join(", ")}`})}function qp(e,t){return(()=>{if(t.value===null&&Rt.value===null)
return yn(e)?.points.latest??NaN;let{from:r,to:o}=Zt(),l=t.value??o,[a,c]=ir(e,{from:r,to:o}),d=NaN;for(let m=0;m<a.length&&
a[m]<=l;++m)d=c[m];return d})()*e.scale+e.offset}function x0(e,t,n){pe.value=pe.value.flatMap((r,o)=>{if(o!==e)return[r];let l=r.flatMap((a,c)=>c!==t?[a]:n?[{...a,...n}]:
[]);return l.length>0?[l]:[]})}function vi(e,t){let n=e.dataTransfer?.getData($s);if(!n)return;e.preventDefault();let{topic:r,
formula:o}=JSON.parse(n);Oo(Wr(String(r),String(o)),t)}var Mn=I(""),zt=I(""),gi=I("new"),w0=St(()=>(jt.value,[...st.values()].
filter(e=>e.schema).map(e=>e.topic).sort())),_i=St(()=>(jt.value,zt.value===""?null:nf(zt.value,Mn.value,e=>st.get(e)?.schema))),
Ma=St(()=>tf(zt.value,Mn.value));function y0(e){e.preventDefault(),!(Ma.value===""||zt.value===""||_i.value)&&(Oo(Wr(Ma.
value,zt.value),gi.value==="new"?null:Number(gi.value)),zt.value="")}function S0(){let e=_i.value;if(!e)return null;let t=zt.
value;return s("p",{class:"fault",role:"alert",id:"fault",children:[s("code",{children:[t.slice(0,e.at),s("mark",{children:t.
slice(e.at,e.at+1)||" "}),t.slice(e.at+1)]}),s("span",{children:["at ",e.at+1,": ",e.message]})]})}var Ta=e=>t=>{e.value=
t.currentTarget.value};function Kp(){Mn.value===""&&zt.value===""&&(Mn.value=ge.value??"")}var k0=()=>s("label",{children:[
"Topic",s("input",{id:"topic",list:"topics",class:"mono",placeholder:"/1/1/VFR_HUD",value:Mn.value,autocomplete:"off",spellcheck:!1,
onFocus:Kp,onInput:Ta(Mn)}),s("datalist",{id:"topics",children:w0.value.slice(0,500).map(e=>s("option",{value:e},e))})]}),
M0=()=>s("label",{class:"grow",children:["Formula",s("input",{id:"formula",class:"mono",placeholder:"sqrt(vx^2 + vy^2) /\
 100",value:zt.value,autocomplete:"off",spellcheck:!1,"aria-invalid":_i.value!==null,"aria-describedby":"fault",title:"F\
ields of another topic have its name before them: /2/1/VFR_HUD.alt",onFocus:Kp,onInput:Ta(zt)})]}),T0=()=>s("label",{children:[
"Into",s("select",{value:gi.value,onChange:Ta(gi),children:[s("option",{value:"new",children:"a new plot"}),pe.value.map(
(e,t)=>s("option",{value:t,children:["plot ",t+1]},t))]})]});function A0(){let e=Mn.value!==""&&!st.has(Mn.value);return s(
"form",{class:"formula",onSubmit:y0,children:[s(k0,{}),s(M0,{}),s(T0,{}),s("button",{type:"submit",disabled:Ma.value===""||
zt.value===""||_i.value!==null,children:"Plot"}),e&&zt.value!==""&&s("p",{class:"fault warning",children:["No ",Mn.value,
" has come yet: the plot waits for it."]}),s(S0,{})]})}function E0(){Kt.value;let e=Rt.value!==null;return s("div",{class:"\
toolbar",children:[s("button",{"aria-pressed":e,onClick:()=>e?zo():lr(),title:"Stop or follow (space)",children:[s(ue,{name:e?
"play":"pause"}),e?"Follow":"Pause"]}),s("label",{children:["Last"," ",s("select",{value:pn.value,onChange:t=>{pn.value=
Number(t.currentTarget.value),zo()},children:ds.map(t=>s("option",{value:t,children:t<60?`${t} s`:`${t/60} min`},t))})]}),
s("span",{class:"group",children:[s("button",{onClick:()=>mn(.5),"aria-label":"Zoom in",title:"Zoom in (+)",children:"+"}),
s("button",{onClick:()=>mn(2),"aria-label":"Zoom out",title:"Zoom out (\u2212)",children:"\u2212"})]}),s("span",{class:"\
summary dim number",children:e&&`stands still \xB7 ${at(sf())} new points`})]})}function N0(e){let[,t]=ir(e,Zt()),n=1/0,
r=-1/0;for(let l of t)l<n&&(n=l),l>r&&(r=l);let o=[n*e.scale+e.offset,r*e.scale+e.offset];return[Math.min(...o),Math.max(
...o)]}function Yp({label:e,value:t,onValue:n}){return s("input",{type:"number",step:"any","aria-label":e,title:e,value:t,
onChange:r=>{n(Number(r.currentTarget.value)||(e==="Scale"?1:0))}})}function P0({series:e}){Kt.value;let t=yn(e),n=t!==void 0&&
t.total===0;if(t?.error||n)return s("td",{class:t?.error?"error":"dim",colSpan:4,children:t?.error||"waits for its first\
 message"});let[r,o]=N0(e);return s(oe,{children:[s("td",{class:"number mono strong",children:Gr(qp(e,hi))}),s("td",{class:"\
dim",children:e.scale===1?t?.unit:""}),s("td",{class:"number mono dim",children:Gr(r)}),s("td",{class:"number mono dim",
children:Gr(o)})]})}function O0({series:e,set:t}){let n=e.axis===1,r=`Axis of ${e.formula}: ${n?"right":"left"}`;return s(
oe,{children:[s("td",{children:s("button",{class:"axis","aria-label":r,title:r,onClick:()=>t({axis:n?0:1}),children:n?"r\
ight":"left"})}),s("td",{children:s(Yp,{label:"Scale",value:e.scale,onValue:o=>t({scale:o})})}),s("td",{children:s(Yp,{label:"\
Offset",value:e.offset,onValue:o=>t({offset:o})})}),s("td",{children:s("button",{class:"quiet","aria-label":`Remove ${e.
formula}`,title:"Remove",onClick:()=>t(null),children:s(ue,{name:"close"})})})]})}function F0({series:e,at:t,index:n}){return s(
"tr",{children:[s("td",{children:s("i",{class:`swatch s${n%ka} d${Math.floor(n/2)%4}`})}),s("th",{scope:"row",class:"mon\
o",children:s("span",{class:"cut",title:`${e.formula} of ${e.topic}`,children:[e.formula," ",!e.formula.includes(e.topic)&&
s("span",{class:"dim",children:e.topic})]})}),s(P0,{series:e}),s(O0,{series:e,set:r=>x0(t,n,r)})]})}function C0({plot:e,
at:t}){return Kt.value,s("table",{class:"legend",children:[s("caption",{class:"hidden",children:["Series of plot ",t+1]}),
s("thead",{children:s("tr",{children:[s("td",{}),s("th",{scope:"col",children:"Series"}),s("th",{scope:"col",class:"numb\
er",children:hi.value===null?"Latest":"Pointer"}),s("td",{}),s("th",{scope:"col",class:"number",children:"Least"}),s("th",
{scope:"col",class:"number",children:"Most"}),s("th",{scope:"col",children:"Axis"}),s("th",{scope:"col",children:"Scale"}),
s("th",{scope:"col",children:"Offset"}),s("td",{})]})}),s("tbody",{children:e.map((n,r)=>s(F0,{series:n,at:t,index:r},`${n.
topic} ${n.formula}`))})]})}function D0({at:e,plot:t,savePicture:n}){let r=()=>{pe.value=pe.value.filter((o,l)=>l!==e)};
return s("header",{children:[s("h3",{children:["Plot ",e+1]}),s("span",{class:"group end",children:[s("button",{onClick:()=>ff(
t),title:"Save what is shown as CSV",children:"CSV"}),s("button",{onClick:n,title:"Save the picture",children:"PNG"}),s(
"button",{class:"quiet",onClick:r,"aria-label":`Remove plot ${e+1}`,title:"Remove the plot",children:s(ue,{name:"close"})})]})]})}
function $0({plot:e,at:t}){let n=an(null),r=l=>{n.current=l},o=()=>{n.current&&pf(n.current.ctx.canvas,e)};return s("sec\
tion",{class:"panel plot","aria-label":`Plot ${t+1}`,onDragOver:l=>l.preventDefault(),onDrop:l=>vi(l,t),children:[s(D0,{
at:t,plot:e,savePicture:o}),s(jp,{plot:e,onChart:r}),s(C0,{plot:e,at:t})]})}function L0(){return s("div",{class:"empty s\
tart",children:[s(ue,{name:"plot"}),s("p",{children:["Open a message under ",s("b",{children:"Messages"})," and click a \
number, or type a formula above."]})]})}var R0={" ":()=>Rt.value?zo():lr(),"+":()=>mn(.5),"=":()=>mn(.5),"-":()=>mn(2),ArrowLeft:()=>Ho(
-.25),ArrowRight:()=>Ho(.25),0:zo,a:()=>jr("#formula")};function Zp(){Dr(()=>Vl(R0),[]),ht.value;let e=ge.value!==null;return s(
oe,{children:[s("h2",{class:"hidden",children:"Plots"}),s("div",{class:"list",onDragOver:t=>t.preventDefault(),onDrop:t=>{
t.defaultPrevented||vi(t,null)},children:[s(E0,{}),s(A0,{}),s("div",{class:"scroller",tabIndex:-1,children:pe.value.length===
0?s(L0,{}):pe.value.map((t,n)=>s($0,{plot:t,at:n},n))})]}),e&&s(Yl,{hz:null})]})}var Jp={overview:"Overview",messages:"Messages",plots:"Plots"};function Xp(e){let t={view:e,query:cn.value,sort:qt.value,
columns:fn.value,opened:ge.value,plots:pe.value,span:pn.value};return`#${Cl(t)}`}var Qp=I(!1);ze(()=>{mt.value&&(Qp.value=
!0)});var io=St(()=>mt.value?"live":Qp.value?"lost":"connecting"),I0=St(()=>zr.value.filter(e=>e.ended_us===null&&e.severity!==
"info"));function Aa({to:e}){let t=e!=="plots"?{}:{onDragOver:n=>n.preventDefault(),onDrop:n=>vi(n,null)};return s("a",{
href:Xp(e),"aria-current":He.value===e?"page":void 0,...t,children:Jp[e]})}function V0(){let e=I0.value,t=e.some(n=>n.severity===
"error")?"error":"warning";return e.length===0?null:s("a",{class:`badge ${t}`,href:Xp("overview"),children:[s(ue,{name:t}),
e.length,s("span",{class:"wide",children:[" ",e.length===1?"alarm":"alarms"]})]})}function z0(){let e={live:"live",lost:"\
lost",connecting:"opening"}[io.value];return s("span",{class:`badge ${io.value}`,title:To.value,children:[s(ue,{name:io.
value}),e]})}function H0(){if(io.value!=="lost")return null;ht.value;let e=Ir.value===null?0:Math.max(0,Math.ceil((Ir.value-
Date.now())/1e3));return s("div",{class:"banner",children:[s(ue,{name:"lost"}),s("span",{children:[s("strong",{children:"\
Connection lost"})," ",Yt((Date.now()-(ko.value??Date.now()))/1e3)," ago. Values are old. ",e>0?`Next attempt in ${e} s.`:
"Connecting\u2026"]}),s("button",{onClick:Ao,children:"Try now"})]})}function U0(){return s("header",{children:[s("h1",{
children:"mavloom"}),s("nav",{"aria-label":"Views",children:[s(Aa,{to:"overview"}),s(Aa,{to:"messages"}),s(Aa,{to:"plots"})]}),
s("div",{class:"right",children:[s(V0,{}),s(z0,{}),s("button",{class:"quiet",onClick:Rl,title:`Colours: ${Dn.value} (t)`,
"aria-label":`Colours: ${Dn.value}`,children:s(ue,{name:Dn.value})}),s("button",{class:"quiet",onClick:()=>{Mt.value=!0},
title:"Keys and licences (?)","aria-label":"Help",children:s(ue,{name:"help"})})]})]})}var W0={overview:Qc,messages:$c,plots:Zp};
function ed(){tt(()=>Qn.use(),[]),tt(()=>{document.title=`${Jp[He.value]} \xB7 Mavloom`},[He.value]);let e=W0[He.value];
return s("div",{class:`app ${io.value}`,children:[s(U0,{}),s(H0,{}),s("main",{class:He.value,children:s(e,{})}),s("div",
{class:"notice",role:"status",hidden:Po.value==="",children:Po.value}),s("div",{class:"hidden",role:"status",children:io.
value==="lost"?"The connection is lost":""}),s(mc,{})]})}rc();vc();rf();Ao();Yu();addEventListener("keydown",pc);var td=document.getElementById("app");td&&gu(s(ed,{}),td);})();
